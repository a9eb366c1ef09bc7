#include "fast_edi/ros/image_pixels.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

/// Two pixels beside each other and the same below, with padding behind each row.
sensor_msgs::Image imageOf(const std::string& encoding, const std::vector<std::uint8_t>& row) {
  sensor_msgs::Image image;
  image.width = 2;
  image.height = 2;
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>(row.size()) + 4;
  for (int y = 0; y < 2; ++y) {
    image.data.insert(image.data.end(), row.begin(), row.end());
    image.data.insert(image.data.end(), 4, 99);
  }
  return image;
}

void expectGrey(const sensor_msgs::Image& image, int left, int right) {
  const cv::Mat grey = greyPixels(image);
  ASSERT_EQ(grey.type(), CV_8UC1);
  ASSERT_EQ(grey.size(), cv::Size(2, 2));
  for (int y = 0; y < 2; ++y) {
    EXPECT_NEAR(grey.at<std::uint8_t>(y, 0), left, 1) << image.encoding;
    EXPECT_NEAR(grey.at<std::uint8_t>(y, 1), right, 1) << image.encoding;
  }
}

TEST(ImagePixelsTest, GreyOfEachEncoding) {
  expectGrey(imageOf("mono8", {10, 200}), 10, 200);
  expectGrey(imageOf("8UC1", {10, 200}), 10, 200);
  // 10 x 257 and 200 x 257, little endian.
  expectGrey(imageOf("mono16", {10, 10, 200, 200}), 10, 200);
  // Weights of red, green and blue: 0.299, 0.587, 0.114.
  expectGrey(imageOf("rgb8", {100, 0, 0, 0, 100, 0}), 30, 59);
  expectGrey(imageOf("bgr8", {100, 0, 0, 0, 100, 0}), 11, 59);
}

TEST(ImagePixelsTest, BayerBecomesGrey) {
  sensor_msgs::Image image;
  image.width = 8;
  image.height = 8;
  image.step = 8;
  image.encoding = "bayer_rggb8";
  image.data.assign(64, 120);
  const cv::Mat grey = greyPixels(image);
  ASSERT_EQ(grey.type(), CV_8UC1);
  EXPECT_NEAR(grey.at<std::uint8_t>(4, 4), 120, 1);
}

TEST(ImagePixelsTest, NothingIsCopiedWithoutNeed) {
  const sensor_msgs::Image image = imageOf("mono8", {1, 2});
  EXPECT_EQ(greyPixels(image).data, image.data.data());
}

TEST(ImagePixelsTest, ColourIsBlueFirst) {
  EXPECT_EQ(colorPixels(imageOf("rgb8", {1, 2, 3, 4, 5, 6})).at<cv::Vec3b>(1, 1),
            cv::Vec3b(6, 5, 4));
  EXPECT_EQ(colorPixels(imageOf("mono8", {10, 200})).at<cv::Vec3b>(1, 1), cv::Vec3b(200, 200, 200));
  EXPECT_EQ(colorPixels(imageOf("8UC1", {10, 200})).at<cv::Vec3b>(0, 0), cv::Vec3b(10, 10, 10));
}

}  // namespace
}  // namespace fast_edi
