// Nodelets with unusable configurations stay idle and say why, see bad_configuration.test.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/init.h>

#include "rostest/child_process.hpp"
#include "rostest/expectations.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

struct Fault {
  const char* ns;
  const char* expected;  ///< in the message
};

class BadConfiguration : public ::testing::TestWithParam<Fault> {};

TEST_P(BadConfiguration, IsReportedAndLeavesTheManagerAlive) {
  const std::string ns = GetParam().ns;
  NodeClient client(ns, ns + "/deblur");
  EXPECT_TRUE(client.waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::ERROR &&
           status.message.find(GetParam().expected) != std::string::npos;
  })) << client.report().message;
  EXPECT_FALSE(client.anyInputConnected()) << "not idle";
}

INSTANTIATE_TEST_SUITE_P(All, BadConfiguration,
                         ::testing::Values(Fault{"/missing", "contrast_threshold_on"},
                                           Fault{"/misspelt", "wieghting"},
                                           Fault{"/out_of_range", "contrast_threshold_on"},
                                           Fault{"/no_off_bias", "contrast_threshold_off"}));

TEST(GoodConfiguration, WorksBesideBadOnes) {
  NodeClient client("/good", "/good/deblur");
  ASSERT_TRUE(client.listen());
  const Recording recording = makeRecording({});
  client.play(recording);
  const std::vector<Output> outputs = client.waitForOutputs(imagesOf(recording).size());
  expectOneOutputForEachFrame(recording, outputs);
  expectSameImages(outputs, deblurWithoutRos(recording, testParameters()));
}

TEST(DeblurNode, EndsWithAnErrorWhenItsConfigurationIsUnusable) {
  ChildProcess node({FAST_EDI_TOOLS_DIR "/deblur_node", "__name:=unconfigured"});
  EXPECT_EQ(node.wait(), 1);
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "bad_configuration");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
