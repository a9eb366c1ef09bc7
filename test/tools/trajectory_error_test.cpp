/// The program `trajectory_error`, run as a user runs it.
#include <cmath>
#include <filesystem>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <gmock/gmock.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using fast_edi::testing::CommandResult;
using fast_edi::testing::runCommand;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/trajectory_error ";

class TrajectoryErrorToolTest : public ::testing::Test {
 protected:
  /// A circle of 2 m radius in 10 s, estimated from the second 1 on with another origin and a drift
  /// of 0.9 m upwards from there to the end.
  std::string writeBag(const std::string& name, bool truth, bool estimate) {
    std::string path = directory_.file(name);
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    constexpr int kCount = 100;
    for (int i = 0; i <= kCount; ++i) {
      const ros::Time stamp(100.0 + 0.1 * i);
      const double angle = 2.0 * M_PI * i / kCount;
      geometry_msgs::PoseStamped pose;
      pose.header.stamp = stamp;
      pose.pose.position.x = 2.0 * std::cos(angle);
      pose.pose.position.y = 2.0 * std::sin(angle);
      if (truth) {
        bag.write("/dvs/ground_truth/pose", stamp, pose);
      }
      nav_msgs::Odometry odometry;
      odometry.header.stamp = stamp;
      odometry.pose.pose.position.x = -pose.pose.position.y + 5.0;
      odometry.pose.pose.position.y = pose.pose.position.x;
      odometry.pose.pose.position.z = 0.01 * (i - 10);
      if (estimate && i >= 10) {
        bag.write("/vins_estimator/odometry", stamp, odometry);
      }
    }
    bag.close();
    return path;
  }

  TemporaryDirectory directory_;
};

TEST_F(TrajectoryErrorToolTest, HelpNamesWhatItTakes) {
  const CommandResult result = runCommand(kTool + "--help");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, AllOf(HasSubstr("--truth"), HasSubstr("--align")));
}

TEST_F(TrajectoryErrorToolTest, PrintsErrorDriftAndTrackedTime) {
  const std::string plot = directory_.file("plot.png");
  const CommandResult result =
      runCommand(kTool + writeBag("both.bag", true, true) + " --plot " + plot);
  EXPECT_EQ(result.exit_code, 0);
  // Drift from -0.45 to 0.45 m about its mean.
  EXPECT_THAT(result.output, AllOf(HasSubstr("absolute trajectory error, RMSE [m]: 0.263\n"),
                                   HasSubstr("drift at the end [m]:                0.900\n"),
                                   HasSubstr("tracked share of the time [%]:       90.0\n"),
                                   HasSubstr("resets:                              0\n"),
                                   HasSubstr("estimates compared, left out:        91, 0\n")));
  EXPECT_TRUE(std::filesystem::exists(plot));
}

TEST_F(TrajectoryErrorToolTest, TakesTheTruthFromAnotherBag) {
  const std::string truth = writeBag("truth.bag", true, false);
  const std::string estimate = writeBag("estimate.bag", false, true);
  const CommandResult result = runCommand(kTool + estimate + " --truth-bag " + truth);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("drift at the end [m]:                0.900\n"));
}

TEST_F(TrajectoryErrorToolTest, NamesWhatIsMissingOrWrong) {
  const CommandResult none = runCommand(kTool + writeBag("truth.bag", true, false));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.output, HasSubstr("truth.bag: no poses on /vins_estimator/odometry"));
  const CommandResult alignment =
      runCommand(kTool + writeBag("both.bag", true, true) + " --align best");
  EXPECT_EQ(alignment.exit_code, 1);
  EXPECT_THAT(alignment.output, HasSubstr("expected yaw, se3 or sim3"));
}

TEST_F(TrajectoryErrorToolTest, ACutBagIsComparedAsFarAsItGoes) {
  const std::string bag = writeBag("both.bag", true, true);
  std::filesystem::resize_file(bag, std::filesystem::file_size(bag) * 4 / 5);
  const CommandResult result = runCommand(kTool + bag);
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("warning: " + bag), HasSubstr("drift at the end")));
}

}  // namespace
}  // namespace fast_edi
