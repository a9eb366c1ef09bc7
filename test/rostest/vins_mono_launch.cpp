// vins_mono.launch with stand-ins for VINS-Mono's nodes: every frame gets there, blurry or
// deblurred, with the inertial readings, and the estimates get into a bag.

#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>

#include "rostest/child_process.hpp"
#include "rostest/free_port.hpp"
#include "rostest/recording.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace test {
namespace {

constexpr std::int64_t kImuPeriod_ns = 5 * kNanosecondsPerMillisecond;

/// Writes a recording and inertial readings from its first to its last message.
void writeBagWithImu(const Recording& recording, const std::string& path) {
  writeBag(recording, "/dvs", path);
  rosbag::Bag bag(path, rosbag::bagmode::Append);
  for (std::int64_t t_ns = recording.front().time_ns; t_ns < recording.back().time_ns;
       t_ns += kImuPeriod_ns) {
    sensor_msgs::Imu imu;
    imu.header.stamp.fromNSec(static_cast<std::uint64_t>(t_ns));
    bag.write("/dvs/imu", imu.header.stamp, imu);
  }
}

double meanOf(const sensor_msgs::Image& image) {
  return std::accumulate(image.data.begin(), image.data.end(), 0.0) /
         static_cast<double>(image.data.size());
}

std::vector<nav_msgs::Odometry> readEstimates(const std::string& path) {
  std::vector<nav_msgs::Odometry> estimates;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    EXPECT_EQ(message.getTopic(), "/vins_estimator/odometry");
    estimates.push_back(*message.instantiate<nav_msgs::Odometry>());
  }
  return estimates;
}

struct LaunchCase {
  std::string camera;
  bool deblur;
};

class VinsMonoLaunch : public ::testing::TestWithParam<LaunchCase> {
 protected:
  void SetUp() override {
    const char* inherited = std::getenv("ROS_PACKAGE_PATH");
    const std::string path = std::string(FAST_EDI_SOURCE_DIR "/test/rostest/stand_in:") +
                             (inherited == nullptr ? "" : inherited);
    setenv("ROS_PACKAGE_PATH", path.c_str(), 1);
    setenv("FAST_EDI_TEST_PROGRAMS", FAST_EDI_TOOLS_DIR, 1);
  }

  TemporaryDirectory directory_;
};

TEST_P(VinsMonoLaunch, FeedsEveryFrameToTheTracker) {
  const std::string in = directory_.file("in.bag");
  const std::string out = directory_.file("out.bag");
  RecordingSettings settings;
  settings.first_exposure_ns = kNanosecondsPerSecond;  // until then everybody has heard the clock
  const Recording recording = makeRecording(settings);
  writeBagWithImu(recording, in);
  ChildProcess launch(
      {"roslaunch", "-p", freePort(), FAST_EDI_SOURCE_DIR "/launch/vins_mono.launch", "bag:=" + in,
       "record:=" + out, "camera:=" + GetParam().camera,
       std::string("deblur:=") + (GetParam().deblur ? "true" : "false"),
       "config:=" FAST_EDI_SOURCE_DIR "/test/rostest/long_timeout.yaml", "settle:=1.0"});
  ASSERT_EQ(launch.wait(), 0);

  std::vector<sensor_msgs::ImageConstPtr> expected = imagesOf(recording);
  if (GetParam().deblur) {
    const std::vector<Output> deblurred = deblurWithoutRos(recording, testParameters());
    ASSERT_EQ(deblurred.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NE(deblurred[i].image->data, expected[i]->data);
      expected[i] = deblurred[i].image;
    }
  }
  const std::vector<nav_msgs::Odometry> estimates = readEstimates(out);
  ASSERT_EQ(estimates.size(), expected.size());
  constexpr double kTolerance_dn = 1e-2;  // a mean in single precision
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const geometry_msgs::Point& told = estimates[i].pose.pose.position;
    EXPECT_EQ(estimates[i].header.stamp, expected[i]->header.stamp) << "frame " << i;
    EXPECT_NEAR(told.z, meanOf(*expected[i]), kTolerance_dn) << "frame " << i;
    EXPECT_EQ(told.y, 0.0) << "the tracker was restarted before frame " << i;
  }
  EXPECT_GT(estimates.back().pose.pose.position.x, 0.0) << "no inertial readings";
}

INSTANTIATE_TEST_SUITE_P(All, VinsMonoLaunch,
                         ::testing::Values(LaunchCase{"davis346", true},
                                           LaunchCase{"davis240c", false}),
                         [](const ::testing::TestParamInfo<LaunchCase>& tested) {
                           return tested.param.camera +
                                  (tested.param.deblur ? "Deblurred" : "Blurry");
                         });

}  // namespace
}  // namespace test
}  // namespace fast_edi
