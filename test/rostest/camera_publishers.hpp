/// \file
/// The topics of a driver, for tests that publish what a camera would.
#pragma once

#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {

/// Inputs of the node within its namespace.
struct InputTopics {
  std::string events = "events";
  std::string image = "image_raw";
  std::string camera_info = "camera_info";
  std::string exposure = "exposure";
};

class CameraPublishers {
 public:
  /// \param nh of the namespace of the topics
  explicit CameraPublishers(ros::NodeHandle nh, const InputTopics& topics = {});

  void publish(const Arrival& arrival) const;
  void publish(const sensor_msgs::ImageConstPtr& image) const { image_.publish(image); }
  /// True while somebody subscribes to all / any of the topics.
  bool allConnected() const;
  bool anyConnected() const;

 private:
  ros::Publisher events_;
  ros::Publisher image_;
  ros::Publisher exposure_;
  ros::Publisher camera_info_;
};

}  // namespace test
}  // namespace fast_edi
