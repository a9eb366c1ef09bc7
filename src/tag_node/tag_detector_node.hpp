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

#include <diagnostic_updater/diagnostic_updater.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/config/tag_detector_parameters.hpp"
#include "fast_edi/events/sequence_gaps.hpp"
#include "fast_edi/tags/tag_detector.hpp"
#include "node/callback_thread.hpp"
#include "node/latency_record.hpp"
#include "node/throttled_warnings.hpp"
#include "tag_node/tag_diagnostics.hpp"

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
  const std::string& configurationError() const { return configuration_error_; }

 private:
  /// Input subscriptions, which come and go together.
  struct Inputs {
    image_transport::Subscriber image;
    ros::Subscriber camera_info;
  };

  void configure();
  void advertise();
  void subscribersChanged();
  std::unique_ptr<Inputs> subscribe();

  void receiveImage(const sensor_msgs::ImageConstPtr& message);
  void receiveCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);
  void publish(const sensor_msgs::Image& image, const std::vector<TagDetection>& tags);
  void report();

  /// Runs a callback's work under the mutex.
  template <typename Work>
  void withLock(Work&& work);

  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
  std::string name_;
  std::string image_topic_;
  std::string configuration_error_;
  TagDetectorParameters parameters_;
  CallbackThread callback_thread_;  ///< for subscribers that come and go; outlives the publishers

  std::mutex mutex_;
  std::optional<TagDetector> detector_;  ///< empty when idle for good
  sensor_msgs::CameraInfoConstPtr camera_info_;
  SequenceGaps gaps_;
  LatencyRecord detection_time_;
  TagDiagnostics diagnostics_;
  TagSnapshot snapshot_;
  ThrottledWarnings warnings_;
  std::int64_t callback_start_ns_ = 0;

  ros::Publisher detections_publisher_;
  image_transport::Publisher annotated_publisher_;
  std::optional<diagnostic_updater::Updater> updater_;
  ros::SteadyTimer report_timer_;
  std::unique_ptr<Inputs> inputs_;  ///< null while nobody listens
};

}  // namespace fast_edi
