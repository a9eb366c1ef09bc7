// The launch files that play a recording: no frame of it may be lost, neither the first nor the
// last. Starts roslaunch itself, with a master of its own.

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "rostest/child_process.hpp"
#include "rostest/expectations.hpp"
#include "rostest/free_port.hpp"
#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace test {
namespace {

std::vector<Output> readOutputs(const std::string& path) {
  std::vector<sensor_msgs::ImageConstPtr> images;
  std::vector<sensor_msgs::CameraInfoConstPtr> infos;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (message.getTopic() == "/dvs/deblurred/image_raw") {
      images.push_back(message.instantiate<sensor_msgs::Image>());
    } else if (message.getTopic() == "/dvs/deblurred/camera_info") {
      infos.push_back(message.instantiate<sensor_msgs::CameraInfo>());
    }
  }
  EXPECT_EQ(images.size(), infos.size());
  std::vector<Output> outputs;
  for (std::size_t i = 0; i < images.size() && i < infos.size(); ++i) {
    outputs.push_back({images[i], infos[i]});
  }
  return outputs;
}

struct LaunchCase {
  const char* file;
  const char* argument;
};

class ReplayLaunch : public ::testing::TestWithParam<LaunchCase> {};

TEST_P(ReplayLaunch, RecordsOneOutputForEachFrame) {
  const TemporaryDirectory directory;
  // What roslaunch splits at, and what a shell or XML could take for something else.
  const std::string in = directory.file("it's \"my\" robot & $HOME [1] (ü).bag");
  const std::string out = directory.file("it's \"my\" output & $HOME [1] (ü).bag");
  const Recording recording = makeRecording({});
  writeBag(recording, "/dvs", in);
  ChildProcess launch(
      {"roslaunch", "-p", freePort(), std::string(FAST_EDI_SOURCE_DIR "/launch/") + GetParam().file,
       "bag:=" + in, "record:=" + out,
       "config:=" FAST_EDI_SOURCE_DIR "/test/rostest/long_timeout.yaml", GetParam().argument});
  ASSERT_EQ(launch.wait(), 0);
  const std::vector<Output> outputs = readOutputs(out);
  expectOneOutputForEachFrame(recording, outputs);
  expectSameImages(outputs, deblurWithoutRos(recording, testParameters()));
}

/// Of another format than rosbag.
TEST(ReplayLaunchOfHdf5, RecordsOneOutputForEachFrame) {
  const TemporaryDirectory directory;
  const std::string bag = directory.file("in.bag");
  const std::string in = directory.file("it's \"my\" robot & $HOME [1].h5");
  const std::string out = directory.file("out.bag");
  const Recording recording = makeRecording({});
  writeBag(recording, "/dvs", bag);
  ChildProcess convert({FAST_EDI_CONVERT_RECORDING, bag, in});
  ASSERT_EQ(convert.wait(), 0);
  ChildProcess launch({"roslaunch", "-p", freePort(), FAST_EDI_SOURCE_DIR "/launch/replay.launch",
                       "bag:=" + in, "record:=" + out,
                       "config:=" FAST_EDI_SOURCE_DIR "/test/rostest/long_timeout.yaml"});
  ASSERT_EQ(launch.wait(), 0);
  const std::vector<Output> outputs = readOutputs(out);
  // Without calibration, which HDF5 does not have.
  const std::vector<Output> expected = deblurWithoutRos(recording, testParameters());
  ASSERT_EQ(outputs.size(), expected.size());
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    EXPECT_EQ(outputs[i].image->header.stamp, expected[i].image->header.stamp);
    EXPECT_EQ(outputs[i].image->data, expected[i].image->data);
  }
}

TEST(ReplayLaunchOfWhatIsNoRecording, Ends) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.txt");
  std::ofstream(in) << "no recording";
  const auto result =
      testing::runCommand("timeout 60 roslaunch -p " + freePort() +
                          " " FAST_EDI_SOURCE_DIR "/launch/replay.launch bag:=" + in);
  EXPECT_NE(result.exit_code, 124) << "it waited for a recording: " << result.output;
  EXPECT_NE(result.output.find("in.txt is no bag, nor another recording"), std::string::npos)
      << result.output;
}

TEST(ReplayLaunchWithoutARecorder, Ends) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.bag");
  writeBag(makeRecording({}), "/dvs", in);
  const auto result =
      testing::runCommand("timeout 60 roslaunch -p " + freePort() +
                          " " FAST_EDI_SOURCE_DIR "/launch/replay.launch bag:=" + in + " record:=" +
                          directory.file("no/such/folder/out.bag") + " use_sim_time:=false");
  EXPECT_NE(result.exit_code, 124) << "it waited for a recorder: " << result.output;
  EXPECT_NE(result.output.find("REQUIRED process [dvs/record"), std::string::npos) << result.output;
}

INSTANTIATE_TEST_SUITE_P(All, ReplayLaunch,
                         ::testing::Values(LaunchCase{"replay.launch", "use_sim_time:=true"},
                                           LaunchCase{"replay.launch", "use_sim_time:=false"},
                                           LaunchCase{"demo.launch", "namespace:=dvs"}));

}  // namespace
}  // namespace test
}  // namespace fast_edi
