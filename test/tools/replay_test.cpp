/// A recording played through roslaunch and the nodelet, and the same through `deblur_bag`.
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::SizeIs;

constexpr int kFrames = 25;

/// A port for a ROS master of the test's own, free a moment ago.
int freePort() {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof(address);
  const bool bound = descriptor >= 0 &&
                     ::bind(descriptor, reinterpret_cast<sockaddr*>(&address), length) == 0 &&
                     ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &length) == 0;
  ::close(descriptor);
  if (!bound) {
    throw std::runtime_error("no free port for a ROS master");
  }
  return ntohs(address.sin_port);
}

struct Outputs {
  std::vector<sensor_msgs::Image> images;
  std::vector<sensor_msgs::CameraInfo> infos;
};

Outputs readOutputs(const std::string& path) {
  Outputs outputs;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (message.getTopic() == "/dvs/deblurred/image_raw") {
      outputs.images.push_back(*message.instantiate<sensor_msgs::Image>());
    } else if (message.getTopic() == "/dvs/deblurred/camera_info") {
      outputs.infos.push_back(*message.instantiate<sensor_msgs::CameraInfo>());
    }
  }
  return outputs;
}

TEST(Replay, PublishesTheBitsThatDeblurBagWrites) {
  const TemporaryDirectory directory;
  const std::string input = directory.file("in.bag");
  const std::string live = directory.file("live.bag");
  const std::string offline = directory.file("offline.bag");
  const std::string config = directory.file("config.yaml");
  test::RecordingSettings settings;
  settings.frames = kFrames;
  // The nodelet hears the calibration at any time before the first frame.
  settings.first_exposure_ns = 300 * kNanosecondsPerMillisecond;
  test::writeBag(test::makeRecording(settings), "/dvs", input);
  // A timeout that no busy machine reaches.
  std::ofstream(config) << "contrast_threshold_on: 0.3\ncontrast_threshold_off: 0.25\n"
                           "close_timeout_ms: 20000\n";

  const std::string port = std::to_string(freePort());
  const auto played = testing::runCommand(
      "ROS_MASTER_URI=http://127.0.0.1:" + port + " ROS_IP=127.0.0.1 ROS_HOME='" +
      directory.file("home") + "' timeout --signal=INT --kill-after=20 120 roslaunch --port " +
      port + " '" FAST_EDI_SOURCE_DIR "/launch/demo.launch' bag:='" + input + "' record:='" + live +
      "' config:='" + config + "'");
  ASSERT_EQ(played.exit_code, 0) << played.output;
  const auto converted =
      testing::runCommand(std::string(FAST_EDI_TOOLS_DIR) + "/deblur_bag --in '" + input +
                          "' --out '" + offline + "' --config '" + config + "'");
  ASSERT_EQ(converted.exit_code, 0) << converted.output;

  const Outputs published = readOutputs(live);
  const Outputs written = readOutputs(offline);
  ASSERT_THAT(written.images, SizeIs(kFrames)) << converted.output;
  ASSERT_THAT(published.images, SizeIs(kFrames)) << played.output;
  ASSERT_THAT(published.infos, SizeIs(kFrames));
  for (std::size_t i = 0; i < kFrames; ++i) {
    SCOPED_TRACE(i);
    // Publishers number their messages themselves.
    EXPECT_EQ(published.images[i].header.stamp, written.images[i].header.stamp);
    EXPECT_EQ(published.images[i].header.frame_id, written.images[i].header.frame_id);
    EXPECT_EQ(published.images[i].encoding, written.images[i].encoding);
    EXPECT_EQ(published.images[i].step, written.images[i].step);
    EXPECT_TRUE(published.images[i].data == written.images[i].data) << "pixels differ";
    EXPECT_EQ(published.infos[i].header.stamp, written.infos[i].header.stamp);
    EXPECT_EQ(published.infos[i].K, written.infos[i].K);
  }
}

}  // namespace
}  // namespace fast_edi
