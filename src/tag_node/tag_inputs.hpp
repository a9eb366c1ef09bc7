/// \file
/// What a tag detector receives: the subscriptions to images and their calibration.
#pragma once

#include <functional>
#include <string>

#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

namespace fast_edi {

/// Both subscriptions, which come and go together. The destructor waits for callbacks at work: the
/// caller must hold no lock that one may want.
class TagInputs {
 public:
  /// Called from the callback queue of the node handle.
  struct Handlers {
    std::function<void(const sensor_msgs::ImageConstPtr&)> image;
    std::function<void(const sensor_msgs::CameraInfoConstPtr&)> camera_info;
  };

  TagInputs(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, const Handlers& handlers);
  TagInputs(const TagInputs&) = delete;
  TagInputs& operator=(const TagInputs&) = delete;

  /// The topic of the images, as resolved.
  static std::string imageTopic(const ros::NodeHandle& nh);

 private:
  image_transport::Subscriber image_;
  ros::Subscriber camera_info_;
};

}  // namespace fast_edi
