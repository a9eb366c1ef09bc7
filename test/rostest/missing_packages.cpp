// Launch files without the packages of others that they start, and what waits for a driver that
// never comes.

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rostest/child_process.hpp"
#include "rostest/free_port.hpp"
#include "rostest/ros_master.hpp"
#include "support/command.hpp"

namespace fast_edi {
namespace test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Missing {
  const char* file;
  const char* arguments;
  const char* package;
  const char* origin;
};

class MissingPackage : public ::testing::TestWithParam<Missing> {};

TEST_P(MissingPackage, IsNamedWithItsOriginAndNothingStarts) {
  const Missing& missing = GetParam();
  const auto result = testing::runCommand("timeout 60 roslaunch -p " + freePort() +
                                          " " FAST_EDI_SOURCE_DIR "/launch/" + missing.file + " " +
                                          missing.arguments);
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr(missing.package), HasSubstr(missing.origin)));
  EXPECT_EQ(result.output.find("process["), std::string::npos) << result.output;
}

INSTANTIATE_TEST_SUITE_P(
    , MissingPackage,
    ::testing::Values(Missing{"live.launch", "", ": davis_ros_driver\n",
                              "https://github.com/uzh-rpg/rpg_dvs_ros"},
                      Missing{"live.launch", "driver_nodelet:=no_such_driver/Nodelet",
                              ": no_such_driver\n", "driver:=false"},
                      Missing{"apriltag.launch", "", ": davis_ros_driver\n",
                              "https://github.com/uzh-rpg/rpg_dvs_ros"},
                      Missing{"vins_mono.launch", "bag:=/none.bag", ": feature_tracker\n",
                              "https://github.com/HKUST-Aerial-Robotics/VINS-Mono"},
                      Missing{"dv_ros.launch", "exposure_time_us:=10000", ": dv_ros_capture\n",
                              "https://gitlab.com/inivation/dv/dv-ros"}));

TEST(DriverSettings, EndAtOnceWhenTheDriverNeverComes) {
  const RosMaster master;
  ::setenv("PYTHONUNBUFFERED", "1", 1);
  ChildProcess settings({FAST_EDI_SOURCE_DIR "/launch/driver_settings", "no_such_driver", "none"});
  // It can be interrupted once it listens.
  const auto known = [] {
    return testing::runCommand("rostopic info /none").output.find("/driver_settings") !=
           std::string::npos;
  };
  const auto start = std::chrono::steady_clock::now();
  while (!known()) {
    ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  }
  const auto interrupted = std::chrono::steady_clock::now();
  settings.send(SIGINT);
  EXPECT_EQ(settings.wait(), 0);
  // roslaunch waits for 15 s before it turns to stronger means.
  EXPECT_LT(std::chrono::steady_clock::now() - interrupted, std::chrono::seconds(10));
}

}  // namespace
}  // namespace test
}  // namespace fast_edi
