/// \file
/// Frames of a stream: images stamped in the middle of their exposure, behind each the exposure's
/// length, and its camera_info if there is a calibration. All are published as pointers.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/CameraInfo.h>

#include "stream/stream_client.hpp"

namespace fast_edi {

class FrameOutput : public StreamSink {
 public:
  /// Advertises `image_raw`, `exposure` and, with a calibration, `camera_info`.
  FrameOutput(ros::NodeHandle nh, std::string frame_id,
              std::optional<sensor_msgs::CameraInfo> calibration);

  void begin(const RecordedStream& stream) override;
  void add(const RecordingItem& item) override;

  /// Frames that came without the start and end of their exposure. From any thread.
  std::uint64_t withoutExposure() const { return without_exposure_; }
  /// Frames of another size than the calibration's, which are published without it. From any
  /// thread.
  std::uint64_t withoutCalibration() const { return without_calibration_; }

 private:
  void publishCalibration(const RecordedFrame& frame, const std_msgs::Header& header);

  const std::string frame_id_;
  const std::optional<sensor_msgs::CameraInfo> calibration_;
  ros::Publisher image_;
  ros::Publisher exposure_;
  ros::Publisher camera_info_;
  std::uint32_t sequence_ = 0;
  std::atomic<std::uint64_t> without_exposure_{0};
  std::atomic<std::uint64_t> without_calibration_{0};
};

}  // namespace fast_edi
