#include "messages/recorded_messages.hpp"

#include <algorithm>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {

ros::Time stampOf(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::clamp<std::int64_t>(t_ns, 0, kLastStamp_ns)));
  return time;
}

void fillImage(const RecordedFrame& frame, sensor_msgs::Image& image) {
  image.header.stamp = stampOf(frame.stamp_ns);
  image.width = static_cast<std::uint32_t>(frame.size.width);
  image.height = static_cast<std::uint32_t>(frame.size.height);
  image.encoding = frame.encoding;
  image.step = image.height == 0 ? 0 : static_cast<std::uint32_t>(frame.bytes / image.height);
  image.data.assign(frame.pixels, frame.pixels + frame.bytes);
}

std_msgs::Int32 exposureMessage(const ExposureInterval& exposure) {
  std_msgs::Int32 message;
  message.data = static_cast<std::int32_t>(
      std::min<std::int64_t>(exposure.length() / kNanosecondsPerMicrosecond, INT32_MAX));
  return message;
}

void fillImu(const RecordedImu& sample, sensor_msgs::Imu& message) {
  message.header.stamp = stampOf(sample.t_ns);
  message.header.frame_id = "base_link";  // the driver's
  message.linear_acceleration.x = sample.acceleration[0];
  message.linear_acceleration.y = sample.acceleration[1];
  message.linear_acceleration.z = sample.acceleration[2];
  message.angular_velocity.x = sample.angular_velocity[0];
  message.angular_velocity.y = sample.angular_velocity[1];
  message.angular_velocity.z = sample.angular_velocity[2];
  message.orientation_covariance[0] = -1.0;  // there is no orientation
}

}  // namespace fast_edi
