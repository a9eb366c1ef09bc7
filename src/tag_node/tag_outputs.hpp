/// \file
/// What a tag detector publishes: detections, and images with the tags drawn in.
#pragma once

#include <functional>

#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/Image.h>
#include <visualization_msgs/MarkerArray.h>

namespace fast_edi {

class TagOutputs {
 public:
  /// Once.
  /// \param on_change called from \p nh's callback queue when a subscriber comes or goes
  void advertise(const ros::NodeHandle& nh, const std::function<void()>& on_change);
  /// Ends both publishers. Waits for a callback at work: the caller must hold no lock that this may
  /// want.
  void shutdown();

  /// Whether an output has a subscriber.
  bool areWanted() const { return detections_.getNumSubscribers() > 0 || isAnnotatedWanted(); }
  bool isAnnotatedWanted() const { return annotated_.getNumSubscribers() > 0; }

  void publishDetections(const visualization_msgs::MarkerArrayPtr& markers) {
    detections_.publish(markers);
  }
  void publishAnnotated(const sensor_msgs::ImagePtr& image) { annotated_.publish(image); }

 private:
  ros::Publisher detections_;
  image_transport::Publisher annotated_;
};

}  // namespace fast_edi
