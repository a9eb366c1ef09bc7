#include "film/frame_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <sensor_msgs/Image.h>
#include <opencv2/imgcodecs.hpp>

#include "fast_edi/recording/recording_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

sensor_msgs::Image image(const std::string& encoding, std::uint32_t pixel_bytes) {
  sensor_msgs::Image image;
  image.header.stamp.fromNSec(1'700'000'000'035'000'001ULL);
  image.encoding = encoding;
  image.width = 5;
  image.height = 4;
  image.step = image.width * pixel_bytes + 3;  // padding
  for (std::uint32_t i = 0; i < image.step * image.height; ++i) {
    image.data.push_back(static_cast<std::uint8_t>(i));
  }
  return image;
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(FrameFolder, ListsTimesAndExposures) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("frames");
  FrameFolder folder(path, false);
  EXPECT_TRUE(folder.add(image("mono8", 1), ExposureInterval{20, 50}));
  EXPECT_TRUE(folder.add(image("rgb8", 3), std::nullopt));
  EXPECT_FALSE(folder.add(image("32FC1", 4), std::nullopt));
  folder.close();
  EXPECT_EQ(folder.frames(), 2u);
  EXPECT_EQ(folder.leftOut(), 1u);
  EXPECT_EQ(contents(path + "/frames.csv"),
            "index,file,stamp_ns,exposure_start_ns,exposure_end_ns\n"
            "0,000000.png,1700000000035000001,20,50\n"
            "1,000001.png,1700000000035000001,,\n");
}

TEST(FrameFolder, KeepsPixels) {
  const TemporaryDirectory directory;
  FrameFolder folder(directory.file("frames"), false);
  const sensor_msgs::Image grey = image("mono8", 1);
  const sensor_msgs::Image wide = image("mono16", 2);
  const sensor_msgs::Image colour = image("rgb8", 3);
  for (const sensor_msgs::Image& frame : {grey, wide, colour}) {
    ASSERT_TRUE(folder.add(frame, std::nullopt));
  }
  const cv::Mat grey_read = cv::imread(directory.file("frames/000000.png"), cv::IMREAD_UNCHANGED);
  const cv::Mat wide_read = cv::imread(directory.file("frames/000001.png"), cv::IMREAD_UNCHANGED);
  const cv::Mat colour_read = cv::imread(directory.file("frames/000002.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(grey_read.type(), CV_8UC1);
  ASSERT_EQ(wide_read.type(), CV_16UC1);
  ASSERT_EQ(colour_read.type(), CV_8UC3);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) {
      EXPECT_EQ(grey_read.at<std::uint8_t>(y, x),
                grey.data[static_cast<std::size_t>(y) * grey.step + static_cast<std::size_t>(x)]);
      const std::size_t at =
          static_cast<std::size_t>(y) * wide.step + static_cast<std::size_t>(x) * 2;
      EXPECT_EQ(wide_read.at<std::uint16_t>(y, x), wide.data[at] | wide.data[at + 1] << 8);
      const std::size_t rgb =
          static_cast<std::size_t>(y) * colour.step + static_cast<std::size_t>(x) * 3;
      EXPECT_EQ(colour_read.at<cv::Vec3b>(y, x),
                cv::Vec3b(colour.data[rgb + 2], colour.data[rgb + 1], colour.data[rgb]));
    }
  }
}

TEST(FrameFolder, IsNotMixedWithAnother) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("frames");
  FrameFolder(path, false).close();
  EXPECT_THROW(FrameFolder(path, false), RecordingError);
  EXPECT_NO_THROW(FrameFolder(path, true).close());
  EXPECT_THROW(FrameFolder("/proc/nowhere", false), RecordingError);
}

}  // namespace
}  // namespace fast_edi
