// A node whose start fails while its inputs come. The last thing that can fail always does in this
// program, which has a ReconfigureServer of its own.

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/spinner.h>
#include <std_msgs/Int32.h>

#include "node/deblur_node.hpp"
#include "node/reconfigure_server.hpp"
#include "rostest/ros_process.hpp"
#include "rostest/stub_camera.hpp"

namespace fast_edi {

class ReconfigureServer::Impl {};

ReconfigureServer::ReconfigureServer(const ros::NodeHandle& /*private_nh*/,
                                     const LiveParameters::Values& /*in_force*/,
                                     Handler /*handler*/) {
  const ros::Publisher input = ros::NodeHandle().advertise<std_msgs::Int32>("/failing/exposure", 1);
  throw std::runtime_error(std::to_string(input.getNumSubscribers()) + " subscriptions to inputs");
}

ReconfigureServer::~ReconfigureServer() = default;

namespace {

const std::string kNamespace = "/failing";
const std::string kNode = "/failing/deblur";

TEST(FailingStart, LeavesNothingThatCallsBack) {
  constexpr int kStarts = 20;
  test::requireRos();
  ros::param::set(kNode + "/contrast_threshold_on", 0.3);
  ros::param::set(kNode + "/contrast_threshold_off", 0.3);
  ros::param::set(kNode + "/lazy", false);
  test::RecordingSettings settings;
  settings.frames = 5;
  const test::StubCamera camera(kNamespace, settings, 10);
  ros::CallbackQueue queue;
  ros::NodeHandle nh(kNamespace);
  ros::NodeHandle private_nh(kNode);
  nh.setCallbackQueue(&queue);
  private_nh.setCallbackQueue(&queue);
  ros::AsyncSpinner spinner(3, &queue);
  spinner.start();
  for (int i = 0; i < kStarts; ++i) {
    std::string error;
    try {
      const DeblurNode node(nh, private_nh, kNode);
    } catch (const std::runtime_error& exception) {
      error = exception.what();
    }
    EXPECT_EQ(error, "0 subscriptions to inputs");
  }
}

}  // namespace
}  // namespace fast_edi
