#include "messages/recorded_messages.hpp"

#include <vector>

#include <gmock/gmock.h>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;

TEST(RecordedMessages, StampsStayWithinWhatROSCanHold) {
  EXPECT_EQ(stampOf(1'500'000'000), ros::Time(1, 500'000'000));
  EXPECT_EQ(stampOf(-1), ros::Time(0, 0));
  EXPECT_EQ(stampOf(kLastStamp_ns), stampOf(INT64_MAX));
}

TEST(RecordedMessages, AFrameKeepsStampSizeAndPixels) {
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  RecordedFrame frame;
  frame.stamp_ns = 2'000'000'001;
  frame.size = {3, 2};
  frame.encoding = "mono16";
  frame.pixels = pixels.data();
  frame.bytes = pixels.size();
  sensor_msgs::Image image;
  fillImage(frame, image);
  EXPECT_EQ(image.header.stamp, ros::Time(2, 1));
  EXPECT_EQ(image.width, 3U);
  EXPECT_EQ(image.height, 2U);
  EXPECT_EQ(image.step, 6U);
  EXPECT_EQ(image.encoding, "mono16");
  EXPECT_EQ(image.data, pixels);
}

TEST(RecordedMessages, AnExposureIsInMicroseconds) {
  EXPECT_EQ(exposureMessage({1'000, 30'001'000}).data, 30'000);
  EXPECT_EQ(exposureMessage({0, 3'000'000'000'000'000}).data, INT32_MAX);
}

TEST(RecordedMessages, AnImuSampleHasNoOrientation) {
  RecordedImu sample;
  sample.t_ns = 3;
  sample.acceleration = {1.0, 2.0, 3.0};
  sample.angular_velocity = {4.0, 5.0, 6.0};
  sensor_msgs::Imu message;
  fillImu(sample, message);
  EXPECT_EQ(message.header.stamp, ros::Time(0, 3));
  EXPECT_EQ(message.header.frame_id, "base_link");
  EXPECT_THAT((std::vector<double>{message.linear_acceleration.x, message.linear_acceleration.y,
                                   message.linear_acceleration.z, message.angular_velocity.x,
                                   message.angular_velocity.y, message.angular_velocity.z}),
              ElementsAre(1.0, 2.0, 3.0, 4.0, 5.0, 6.0));
  EXPECT_EQ(message.orientation_covariance[0], -1.0);
}

}  // namespace
}  // namespace fast_edi
