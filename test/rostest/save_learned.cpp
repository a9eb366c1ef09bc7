// A node learns, saves what it has learned by its service, and another one starts from there: see
// save_learned.test.
//
//   /learning  thresholds that are too low, learned_file

#include <cmath>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <ros/init.h>
#include <ros/param.h>
#include <ros/service.h>
#include <std_srvs/Trigger.h>

#include "fast_edi/base/number_text.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "rostest/child_process.hpp"
#include "rostest/driver_shape.hpp"
#include "rostest/node_client.hpp"

namespace fast_edi {
namespace test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kService = "/learning/deblur/save_learned";
const ContrastThresholds kGiven{0.2, 0.18};
const ContrastThresholds kTrue{0.26, 0.24};

std_srvs::Trigger::Response save() {
  std_srvs::Trigger call;
  EXPECT_TRUE(ros::service::waitForService(kService, 30'000));
  EXPECT_TRUE(ros::service::call(kService, call));
  return call.response;
}

TEST(SaveLearned, TheNextRunStartsFromWhatThisOneLearned) {
  std::string path;
  ASSERT_TRUE(ros::param::get("/learning/deblur/learned_file", path));

  const std_srvs::Trigger::Response early = save();
  EXPECT_FALSE(early.success);
  EXPECT_THAT(early.message, HasSubstr("nothing has been learned"));
  EXPECT_FALSE(std::filesystem::exists(path));

  const SimulatedRecording simulated = simulateRecording(
      FAST_EDI_TOOLS_DIR, davisRosDriver(),
      "--width 160 --height 120 --frames 8 --density 1 --exposure-us 25000 --threshold-on " +
          numberText(kTrue.on) + " --threshold-off " + numberText(kTrue.off));
  {
    NodeClient client("/learning", "/learning/deblur");
    ASSERT_TRUE(client.listen());
    client.play(simulated.recording);
    client.waitForOutputs(simulated.truth.size());
    const std_srvs::Trigger::Response response = save();
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_THAT(response.message, AllOf(HasSubstr(path), HasSubstr("contrast_threshold_on")));
  }
  const LoadedParameters learned = parametersFromFile(path);
  EXPECT_LT(std::abs(learned.deblur.thresholds.on - kTrue.on), kTrue.on - kGiven.on);
  EXPECT_LT(std::abs(learned.deblur.thresholds.off - kTrue.off), kTrue.off - kGiven.off);

  NodeClient again("/again", "/again/deblur");
  const ChildProcess launch(
      {"roslaunch", FAST_EDI_SOURCE_DIR "/launch/live.launch", "driver:=false", "namespace:=again",
       "config:=" FAST_EDI_SOURCE_DIR "/test/rostest/long_timeout.yaml", "learned:=" + path});
  const auto numberIn = [](const diagnostic_msgs::DiagnosticStatus& status,
                           const std::string& key) {
    const std::string text = valueOf(status, key);
    return text.empty() ? std::nan("") : std::stod(text);
  };
  EXPECT_TRUE(again.waitForReport([&](const diagnostic_msgs::DiagnosticStatus& status) {
    return std::abs(numberIn(status, "Contrast threshold ON") - learned.deblur.thresholds.on) <
               1e-6 &&
           std::abs(numberIn(status, "Contrast threshold OFF") - learned.deblur.thresholds.off) <
               1e-6;
  }));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleMock(&argc, argv);
  ros::init(argc, argv, "save_learned");
  return RUN_ALL_TESTS();
}
