#include "rostest/camera_publishers.hpp"

namespace fast_edi {
namespace test {
namespace {

constexpr std::uint32_t kQueue = 1000;

}  // namespace

CameraPublishers::CameraPublishers(ros::NodeHandle nh, const InputTopics& topics)
    : events_(nh.advertise<EventArray>(topics.events, kQueue)),
      image_(nh.advertise<sensor_msgs::Image>(topics.image, kQueue)),
      exposure_(nh.advertise<std_msgs::Int32>(topics.exposure, kQueue)),
      camera_info_(nh.advertise<sensor_msgs::CameraInfo>(topics.camera_info, kQueue)) {}

void CameraPublishers::publish(const Arrival& arrival) const {
  if (arrival.events) {
    events_.publish(arrival.events);
  } else if (arrival.image) {
    image_.publish(arrival.image);
  } else if (arrival.info) {
    camera_info_.publish(arrival.info);
  } else {
    exposure_.publish(arrival.exposure);
  }
}

bool CameraPublishers::allConnected() const {
  return events_.getNumSubscribers() > 0 && image_.getNumSubscribers() > 0 &&
         exposure_.getNumSubscribers() > 0 && camera_info_.getNumSubscribers() > 0;
}

bool CameraPublishers::anyConnected() const {
  return events_.getNumSubscribers() > 0 || image_.getNumSubscribers() > 0 ||
         exposure_.getNumSubscribers() > 0 || camera_info_.getNumSubscribers() > 0;
}

}  // namespace test
}  // namespace fast_edi
