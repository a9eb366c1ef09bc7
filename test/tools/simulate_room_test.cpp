/// The program `simulate_davis` in its room, run as a user runs it.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>

#include "fast_edi/base/types.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/simulate_davis ";
constexpr std::int64_t kStartNs = 1'700'000'000 * kNanosecondsPerSecond;
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

std::int64_t stampNs(const std_msgs::Header& header) {
  return static_cast<std::int64_t>(header.stamp.toNSec());
}

TEST(SimulateRoomTool, WritesImuAndPosesBesideWhatTheDriverWrites) {
  const TemporaryDirectory directory;
  const auto result = testing::runCommand(
      kTool + "--scene room --out " + directory.file("room.bag") +
      " --sensor davis240c --duration 0.25 --texel-m 0.02 --gentle-s 0 --imu-rate 500");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("room.bag: 5 frames, "));

  std::map<std::string, int> counts;
  std::vector<std::int64_t> imu_ns;
  std::vector<std::int64_t> image_ns;
  std::vector<std::int64_t> truth_ns;
  std::vector<geometry_msgs::PoseStamped> poses;
  double largest_turning = 0.0;
  std::int64_t last_record_ns = 0;
  const rosbag::Bag bag(directory.file("room.bag"));
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    const std::string& topic = message.getTopic();
    ++counts[topic];
    const auto record_ns = static_cast<std::int64_t>(message.getTime().toNSec());
    EXPECT_GE(record_ns, last_record_ns);
    last_record_ns = record_ns;
    if (topic == "/dvs/imu") {
      const auto imu = message.instantiate<sensor_msgs::Imu>();
      imu_ns.push_back(stampNs(imu->header));
      EXPECT_EQ(imu->header.frame_id, "imu");
      EXPECT_EQ(imu->orientation_covariance[0], -1.0);
      // Density squared times rate.
      EXPECT_NEAR(imu->linear_acceleration_covariance[4], 4e-3 * 4e-3 * 500.0, 1e-12);
      EXPECT_NEAR(imu->angular_velocity_covariance[8], 2e-4 * 2e-4 * 500.0, 1e-12);
      const auto& a = imu->linear_acceleration;
      if (imu_ns.size() == 1) {
        EXPECT_NEAR(a.y, -9.81, 0.6);  // at rest: gravity, bias and noise
      }
      const auto& w = imu->angular_velocity;
      largest_turning = std::max(largest_turning, std::hypot(w.x, w.y));
    } else if (topic == "/dvs/image_raw") {
      image_ns.push_back(stampNs(message.instantiate<sensor_msgs::Image>()->header));
    } else if (topic == "/dvs/ground_truth/image_raw") {
      truth_ns.push_back(stampNs(message.instantiate<sensor_msgs::Image>()->header));
    } else if (topic == "/dvs/ground_truth/pose") {
      poses.push_back(*message.instantiate<geometry_msgs::PoseStamped>());
    } else if (topic == "/dvs/camera_info") {
      const auto info = message.instantiate<sensor_msgs::CameraInfo>();
      EXPECT_DOUBLE_EQ(info->K[0], 0.7 * 240);
      EXPECT_DOUBLE_EQ(info->K[2], 119.5);
      EXPECT_THAT(info->D, ElementsAre(0.0, 0.0, 0.0, 0.0, 0.0));
    }
  }
  EXPECT_GT(counts["/dvs/events"], 10);
  EXPECT_EQ(counts["/dvs/exposure"], 5);

  // Mid-exposures: 100 ms lead, half of 40 ms, every 50 ms.
  ASSERT_EQ(image_ns.size(), 5U);
  ASSERT_EQ(poses.size(), 5U);
  for (std::size_t i = 0; i < image_ns.size(); ++i) {
    EXPECT_EQ(image_ns[i], kStartNs + (120 + 50 * static_cast<std::int64_t>(i)) * kMs);
    EXPECT_EQ(stampNs(poses[i].header), image_ns[i]);
    EXPECT_EQ(poses[i].header.frame_id, "world");
    const auto& q = poses[i].pose.orientation;
    EXPECT_NEAR(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1.0, 1e-12);
    EXPECT_NEAR(poses[i].pose.position.z, 1.5, 0.3);
  }
  EXPECT_EQ(truth_ns, image_ns);

  // From the recording's start to its end, 450 ms in all, every 2 ms.
  ASSERT_EQ(imu_ns.size(), 226U);
  for (std::size_t i = 0; i < imu_ns.size(); ++i) {
    EXPECT_EQ(imu_ns[i], kStartNs + static_cast<std::int64_t>(i) * 2 * kMs);
  }
  EXPECT_GT(largest_turning, 0.3);  // it is shaken
}

TEST(SimulateRoomTool, NamesWhatItCannotDo) {
  const TemporaryDirectory directory;
  const std::string command = kTool + "--out " + directory.file("a.bag");
  const auto outputOf = [&](const std::string& options) {
    const auto result = testing::runCommand(command + " " + options);
    EXPECT_EQ(result.exit_code, 1) << options;
    return result.output;
  };
  EXPECT_THAT(outputOf("--scene room --duration 1 --frames 20"),
              HasSubstr("--duration: expected without"));
  EXPECT_THAT(outputOf("--scene room --duration 0"), HasSubstr("--duration: expected more than 0"));
  EXPECT_THAT(outputOf("--scene room --tags 4"), HasSubstr("tags in the room"));
  EXPECT_THAT(outputOf("--scene room --encoding rgb8"), HasSubstr("colour filter"));
  EXPECT_THAT(outputOf("--scene moon"), HasSubstr("expected one of plane, room"));
}

}  // namespace
}  // namespace fast_edi
