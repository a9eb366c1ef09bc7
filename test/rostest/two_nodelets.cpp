// Two nodelets of one manager share a camera and differ in a parameter, see two_nodelets.test.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/init.h>

#include "rostest/expectations.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {
namespace {

TEST(TwoNodelets, DoNotDisturbEachOther) {
  NodeClient first("/camera", "/camera/first");
  NodeClient second("/camera", "/camera/second", "counted");
  ASSERT_TRUE(first.listen());
  ASSERT_TRUE(second.listen());
  // They share connections, so that those of the first say nothing of the second.
  ASSERT_TRUE(second.waitForReport([](const diagnostic_msgs::DiagnosticStatus& status) {
    return status.message.find("idle") == std::string::npos;
  }));
  const Recording recording = makeRecording({});
  first.play(recording);
  const std::size_t frames = imagesOf(recording).size();
  const std::vector<Output> timed = first.waitForOutputs(frames);
  const std::vector<Output> counted = second.waitForOutputs(frames);
  expectOneOutputForEachFrame(recording, timed);
  expectOneOutputForEachFrame(recording, counted);
  DeblurParameters parameters = testParameters();
  expectSameImages(timed, deblurWithoutRos(recording, parameters));
  parameters.weighting = Weighting::kCounter;
  expectSameImages(counted, deblurWithoutRos(recording, parameters));
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "two_nodelets");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
