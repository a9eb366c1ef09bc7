/// \file
/// A camera that never ends.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include <ros/node_handle.h>

#include "rostest/camera_publishers.hpp"
#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {

/// Publishes made-up recordings one behind the other, in a thread of its own, as a driver would:
/// events, frames, exposures and calibrations whose times go on from one to the next.
class StubCamera {
 public:
  /// \param ns namespace of the topics
  /// \param settings of the first recording; `frames` is the length of each
  /// \param haste how much faster than the clock on the wall recording time passes
  StubCamera(const std::string& ns, RecordingSettings settings, int haste);
  ~StubCamera();
  StubCamera(const StubCamera&) = delete;
  StubCamera& operator=(const StubCamera&) = delete;

 private:
  void run(RecordingSettings settings, int haste);

  ros::NodeHandle nh_;
  const CameraPublishers publishers_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace test
}  // namespace fast_edi
