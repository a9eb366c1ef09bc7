/// The deblurred frames of a rosbag2 are those of the same recording as a bag.
#include <gtest/gtest.h>
#include <sensor_msgs/Imu.h>

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/bag_reader.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
const std::string kData = std::string(FAST_EDI_SOURCE_DIR) + "/test/data/recordings/";

/// Messages on a topic, serialised, without the number of each in front.
std::vector<std::string> messagesOn(const std::string& bag, const std::string& topic) {
  std::vector<std::string> messages;
  BagReader reader(bag);
  BagMessage message;
  while (reader.next(message)) {
    if (message.connection->topic == topic) {
      messages.emplace_back(reinterpret_cast<const char*>(message.data) + sizeof(std::uint32_t),
                            message.size - sizeof(std::uint32_t));
    }
  }
  return messages;
}

std::vector<std::string> deblurredFrames(const std::string& recording, const std::string& output) {
  const testing::CommandResult result =
      testing::runCommand(kTools + "deblur_bag --in '" + recording + "' --out '" + output +
                          "' --config '" + FAST_EDI_SOURCE_DIR + "/cfg/davis346.yaml'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  return messagesOn(output, "/dvs/deblurred/image_raw");
}

/// Time, acceleration and angular velocity.
using ImuReading = std::tuple<std::uint64_t, double, double, double, double, double, double>;

std::vector<ImuReading> imuOn(const std::string& bag) {
  std::vector<ImuReading> samples;
  BagReader reader(bag);
  BagMessage message;
  while (reader.next(message)) {
    if (message.connection->topic == "/dvs/imu") {
      const auto imu = deserialise<sensor_msgs::Imu>(message);
      samples.emplace_back(imu->header.stamp.toNSec(), imu->linear_acceleration.x,
                           imu->linear_acceleration.y, imu->linear_acceleration.z,
                           imu->angular_velocity.x, imu->angular_velocity.y,
                           imu->angular_velocity.z);
    }
  }
  return samples;
}

class Rosbag2Tools : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Rosbag2Tools,
                         ::testing::Values("sqlite", "mcap_chunk", "sqlite_file", "mcap_message",
                                           "libcaer", "big_endian", "png"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(Rosbag2Tools, DeblurTheFramesOfTheBag) {
  const TemporaryDirectory directory;
  const std::string bag = directory.file("in.bag");
  // The vendor's file of the same recording, as a bag.
  const testing::CommandResult converted = testing::runCommand(
      kTools + "convert_recording '" + kData + "vendor_none.aedat4' '" + bag + "'");
  ASSERT_EQ(converted.exit_code, 0) << converted.output;
  const std::vector<std::string> expected = deblurredFrames(bag, directory.file("bag.bag"));
  EXPECT_EQ(expected.size(), 3U);
  EXPECT_EQ(deblurredFrames(kData + "rosbag2/" + GetParam(), directory.file("rosbag2.bag")),
            expected);
}

/// Frames of 16 bits, and IMU samples.
class Rosbag2Room : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Rosbag2Room, ::testing::Values("room_big_endian", "room_png"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(Rosbag2Room, IsThatOfTheBag) {
  const TemporaryDirectory directory;
  const std::string bag = kData + "room.bag";
  std::vector<std::string> expected = deblurredFrames(bag, directory.file("bag.bag"));
  ASSERT_EQ(expected.size(), 3U);
  const std::string rosbag2 = kData + "rosbag2/" + GetParam();
  const std::vector<std::string> found = deblurredFrames(rosbag2, directory.file("rosbag2.bag"));
  ASSERT_GE(found.size(), 2U);
  expected.resize(found.size());
  EXPECT_EQ(found, expected);
  const testing::CommandResult converted = testing::runCommand(
      kTools + "convert_recording '" + rosbag2 + "' '" + directory.file("again.bag") + "'");
  ASSERT_EQ(converted.exit_code, 0) << converted.output;
  const std::vector<ImuReading> samples = imuOn(directory.file("again.bag"));
  std::vector<ImuReading> recorded = imuOn(bag);
  ASSERT_GT(samples.size(), 50U);
  ASSERT_GE(recorded.size(), samples.size());
  recorded.resize(samples.size());
  EXPECT_EQ(samples, recorded);
}

}  // namespace
}  // namespace fast_edi
