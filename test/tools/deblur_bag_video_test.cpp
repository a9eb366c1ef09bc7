/// The high-rate video of the program `deblur_bag`, run as a user runs it.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/deblur_bag ";
const std::string kThresholds = " contrast_threshold_on:=0.3 contrast_threshold_off:=0.25";

/// Ten exposures of 10 ms, one each 40 ms; events all the time.
class DeblurBagVideo : public ::testing::Test {
 protected:
  DeblurBagVideo() {
    settings_.frames = 10;
    recording_ = test::makeRecording(settings_);
    test::writeBag(recording_, "/dvs", path("in.bag"));
  }

  std::string path(const std::string& name) const { return directory_.file(name); }
  testing::CommandResult run(const std::string& arguments) const {
    return testing::runCommand(kTool + "--in '" + path("in.bag") + "' " + arguments);
  }

  const TemporaryDirectory directory_;
  test::RecordingSettings settings_;
  test::Recording recording_;
};

TEST_F(DeblurBagVideo, IsAFilmFromTheFirstExposureToTheLast) {
  const auto result = run("--video '" + path("film.mp4") + "' --fps 500" + kThresholds);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  // Each 2 ms, beginning with the first exposure; they begin at whole milliseconds.
  const std::int64_t length_ns = 9 * settings_.frame_period_ns + settings_.exposure_ns;
  const auto expected = static_cast<int>(length_ns / (2 * kMs));
  EXPECT_THAT(result.output, HasSubstr("film: " + std::to_string(expected) + " images\n"));
  EXPECT_THAT(result.output, Not(HasSubstr("held")));

  cv::VideoCapture film(path("film.mp4"));
  ASSERT_TRUE(film.isOpened());
  EXPECT_EQ(film.get(cv::CAP_PROP_FPS), 30.0);
  cv::Mat picture;
  int images = 0;
  while (film.read(picture)) {
    EXPECT_EQ(picture.size(), cv::Size(settings_.size.width, settings_.size.height));
    ++images;
  }
  EXPECT_EQ(images, expected);
}

TEST_F(DeblurBagVideo, HoldsFramesWithoutExposure) {
  settings_.exposures = false;
  test::writeBag(test::makeRecording(settings_), "/dvs", path("in.bag"));
  const auto result = run("--video '" + path("film.avi") + "' --fps 100" + kThresholds);
  ASSERT_EQ(result.exit_code, 3) << result.output;
  // From the first stamp to the last, 360 ms apart and off the film's instants by half an exposure.
  EXPECT_THAT(result.output, HasSubstr("film: 36 images, 36 of them held"));
}

TEST_F(DeblurBagVideo, GoesAlongWithABag) {
  const auto result = run("--video '" + path("film.mp4") + "' --out '" + path("out.bag") + "'" +
                          kThresholds + " latent_images:=2");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(std::filesystem::exists(path("film.mp4")));
  const rosbag::Bag bag(path("out.bag"));
  EXPECT_EQ(rosbag::View(bag, rosbag::TopicQuery("/dvs/deblurred/image_raw")).size(), 10u);
}

TEST_F(DeblurBagVideo, IsWrittenIntoTheBagWhenAskedFor) {
  const auto result = run("--out '" + path("out.bag") + "'" + kThresholds + " latent_images:=4");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const rosbag::Bag bag(path("out.bag"));
  rosbag::View view(bag, rosbag::TopicQuery("/dvs/latent/image_raw"));
  EXPECT_EQ(view.size(), 10u * 4u + 9u * 4u);
  ros::Time last;
  for (const rosbag::MessageInstance& message : view) {
    const auto image = message.instantiate<sensor_msgs::Image>();
    ASSERT_NE(image, nullptr);
    EXPECT_GT(image->header.stamp, last);
    EXPECT_EQ(image->encoding, "mono8");
    last = image->header.stamp;
  }
}

TEST_F(DeblurBagVideo, RefusesWhatItCannotWrite) {
  const std::string film = " --video '" + path("film.mp4") + "'";
  for (const auto& [arguments, complaint] : std::vector<std::pair<std::string, std::string>>{
           {"", "neither --out nor --out-dir nor --video nor --frames is given"},
           {film + " --fps 0", "--fps 0: expected 1..100000"},
           {" --video '" + path("film.webm") + "'", "expected .mp4, .mov or .avi"},
           {" --video '" + path("nowhere/film.mp4") + "'", "No such file or directory"}}) {
    const auto result = run(kThresholds + arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.output, HasSubstr(complaint));
  }
}

}  // namespace
}  // namespace fast_edi
