#include "node/learned_service.hpp"

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <ros/names.h>
#include <ros/service.h>
#include <ros/service_client.h>

#include "fast_edi/config/learned_file.hpp"
#include "node/callback_thread.hpp"
#include "rostest/ros_process.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// An environment variable as a test wants it.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    const char* before = std::getenv(name);
    before_ = before != nullptr ? before : "";
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() {
    if (before_.empty()) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, before_.c_str(), 1);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string before_;
};

TEST(LearnedFilePath, IsTheGivenOne) {
  const Variable home("ROS_HOME", "/home/robot/.ros");
  EXPECT_EQ(learnedFilePath("/data/camera.yaml", "/dvs/deblur"), "/data/camera.yaml");
  EXPECT_EQ(learnedFilePath("camera.yaml", "/dvs/deblur"), "/home/robot/.ros/camera.yaml");
}

TEST(LearnedFilePath, HasTheNameOfTheNodeInTheFolderOfRos) {
  const Variable home("HOME", "/home/robot");
  {
    const Variable ros_home("ROS_HOME", "/var/ros");
    EXPECT_EQ(learnedFilePath("", "/dvs/left/deblur"), "/var/ros/dvs_left_deblur_learned.yaml");
  }
  const Variable ros_home("ROS_HOME", "");
  EXPECT_EQ(learnedFilePath("", "/deblur"), "/home/robot/.ros/deblur_learned.yaml");
}

class LearnedServiceTest : public ::testing::Test {
 protected:
  LearnedServiceTest() {
    test::requireRos();
    status_.thresholds = {0.25, 0.3};
    status_.event_delay_ns = 1'234'000;
    status_.learned_pairs = 7;
  }
  ~LearnedServiceTest() override { thread_.stop(); }

  std_srvs::Trigger::Response save(const std::string& path) {
    service_ = std::make_unique<LearnedService>(thread_.handle(ros::NodeHandle("/saving")), path,
                                                [this] { return status_; });
    thread_.start();
    std_srvs::Trigger call;
    EXPECT_TRUE(ros::service::call("/saving/save_learned", call));
    return call.response;
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("learned.yaml");
  DeblurStatus status_;
  CallbackThread thread_;
  std::unique_ptr<LearnedService> service_;
};

TEST_F(LearnedServiceTest, WritesWhatIsInForceAndSaysSo) {
  const std_srvs::Trigger::Response response = save(path_);
  EXPECT_TRUE(response.success);
  EXPECT_THAT(response.message,
              AllOf(HasSubstr("written: " + path_), HasSubstr("contrast_threshold_on: 0.2500"),
                    HasSubstr("event_delay_us: 1234"), HasSubstr("7 pairs")));
  EXPECT_THAT(learnedOverrides(path_),
              ElementsAre("contrast_threshold_on:=0.2500", "contrast_threshold_off:=0.3000",
                          "event_delay_us:=1234"));
}

TEST_F(LearnedServiceTest, WritesNothingBeforeAnythingWasLearned) {
  status_.learned_pairs = 0;
  const std_srvs::Trigger::Response response = save(path_);
  EXPECT_FALSE(response.success);
  EXPECT_THAT(response.message,
              AllOf(HasSubstr("not written: nothing"), HasSubstr("refine_contrast")));
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(LearnedServiceTest, SaysWhyTheFileCannotBeWritten) {
  const std::string missing = directory_.file("missing/learned.yaml");
  const std_srvs::Trigger::Response response = save(missing);
  EXPECT_FALSE(response.success);
  EXPECT_THAT(response.message,
              AllOf(HasSubstr("not written"), HasSubstr(missing), HasSubstr("No such file")));
}

TEST_F(LearnedServiceTest, MakesTheFolderOfRosAlone) {
  const std::string home = directory_.file("ros");
  const Variable ros_home("ROS_HOME", home);
  EXPECT_TRUE(save(learnedFilePath("", "/dvs/deblur")).success);
  EXPECT_TRUE(fs::exists(home + "/dvs_deblur_learned.yaml"));
}

}  // namespace
}  // namespace fast_edi
