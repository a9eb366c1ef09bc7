/// \file
/// AprilTags in a stream of images, the same for node and nodelet: topics, parameters and
/// diagnostics around a TagDetector. Topic names are relative; launch/apriltags.md lists them.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/config/tag_detector_parameters.hpp"
#include "fast_edi/tags/tag_detector.hpp"
#include "node/callback_thread.hpp"
#include "node/periodic_callback.hpp"
#include "tag_node/tag_inputs.hpp"
#include "tag_node/tag_outputs.hpp"
#include "tag_node/tag_report.hpp"

namespace fast_edi {

/// Threads: see DeblurNode. No exception leaves a callback: one that gets here is logged and
/// reported; the next image is processed as usual.
class TagDetectorNode {
 public:
  /// A configuration that cannot be used is logged and reported on /diagnostics; the object then
  /// stays idle, see configurationError().
  /// \param name as shown in log and diagnostics, with a leading slash
  TagDetectorNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                  const std::string& name);
  ~TagDetectorNode();
  TagDetectorNode(const TagDetectorNode&) = delete;
  TagDetectorNode& operator=(const TagDetectorNode&) = delete;

  /// Empty unless the configuration was refused.
  const std::string& configurationError() const { return report_.totals().configuration_error; }

 private:
  void configure(const std::string& name);
  void subscribersChanged();
  std::unique_ptr<TagInputs> subscribe();

  void receiveImage(const sensor_msgs::ImageConstPtr& message);
  void receiveCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);
  void publish(const sensor_msgs::Image& image, const std::vector<TagDetection>& tags);
  void report();

  /// Runs a callback's work under the mutex.
  template <typename Work>
  void withLock(Work&& work);

  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
  TagDetectorParameters parameters_;
  CallbackThread callback_thread_;  ///< for subscribers that come and go; outlives the publishers

  std::mutex mutex_;
  TagReport report_;
  std::optional<TagDetector> detector_;  ///< empty when idle for good
  sensor_msgs::CameraInfoConstPtr camera_info_;
  TagOutputs outputs_;
  std::int64_t callback_start_ns_ = 0;
  std::optional<PeriodicCallback> reporting_;
  std::unique_ptr<TagInputs> inputs_;  ///< null while nobody listens
};

}  // namespace fast_edi
