#include "fast_edi/messages/image_pixels.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
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
  expectGrey(imageOf("rgba8", {100, 0, 0, 7, 0, 100, 0, 7}), 30, 59);
  expectGrey(imageOf("bgra8", {100, 0, 0, 7, 0, 100, 0, 7}), 11, 59);
  expectGrey(imageOf("rgb16", {100, 100, 0, 0, 0, 0, 0, 0, 100, 100, 0, 0}), 30, 59);
  expectGrey(imageOf("bgr16", {100, 100, 0, 0, 0, 0, 0, 0, 100, 100, 0, 0}), 11, 59);
  expectGrey(imageOf("rgba16", {100, 100, 0, 0, 0, 0, 7, 7, 0, 0, 100, 100, 0, 0, 7, 7}), 30, 59);
  expectGrey(imageOf("bgra16", {100, 100, 0, 0, 0, 0, 7, 7, 0, 0, 100, 100, 0, 0, 7, 7}), 11, 59);
}

TEST(ImagePixelsTest, BayerBecomesGrey) {
  sensor_msgs::Image image;
  image.width = 8;
  image.height = 8;
  for (const std::uint32_t bytes : {1U, 2U}) {
    image.step = 8 * bytes;
    image.encoding = bytes == 1 ? "bayer_rggb8" : "bayer_rggb16";
    image.data.assign(64 * bytes, 120);
    const cv::Mat grey = greyPixels(image);
    ASSERT_EQ(grey.type(), CV_8UC1);
    EXPECT_NEAR(grey.at<std::uint8_t>(4, 4), 120, 1);
  }
}

TEST(ImagePixelsTest, NothingIsCopiedWithoutNeed) {
  const sensor_msgs::Image image = imageOf("mono8", {1, 2});
  EXPECT_EQ(greyPixels(image).data, image.data.data());
}

TEST(ImagePixelsTest, ColourIsBlueFirst) {
  EXPECT_EQ(colourPixels(imageOf("rgb8", {1, 2, 3, 4, 5, 6})).at<cv::Vec3b>(1, 1),
            cv::Vec3b(6, 5, 4));
  EXPECT_EQ(colourPixels(imageOf("rgba8", {1, 2, 3, 9, 4, 5, 6, 9})).at<cv::Vec3b>(1, 1),
            cv::Vec3b(6, 5, 4));
  EXPECT_EQ(
      colourPixels(imageOf("bgr16", {1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6})).at<cv::Vec3b>(1, 1),
      cv::Vec3b(4, 5, 6));
  EXPECT_EQ(colourPixels(imageOf("mono8", {10, 200})).at<cv::Vec3b>(1, 1),
            cv::Vec3b(200, 200, 200));
  EXPECT_EQ(colourPixels(imageOf("8UC1", {10, 200})).at<cv::Vec3b>(0, 0), cv::Vec3b(10, 10, 10));
}

TEST(ImagePixelsTest, BayerPatternsAreTold) {
  // Red alone: the photosites that OpenCV must take for red are those of the pattern's name.
  const std::vector<std::pair<std::string, cv::Point>> red_sites = {{"bayer_rggb8", {0, 0}},
                                                                    {"bayer_bggr8", {1, 1}},
                                                                    {"bayer_gbrg8", {0, 1}},
                                                                    {"bayer_grbg8", {1, 0}}};
  for (const auto& [encoding, site] : red_sites) {
    sensor_msgs::Image image;
    image.width = 8;
    image.height = 8;
    image.step = 8;
    image.encoding = encoding;
    image.data.assign(64, 0);
    for (int y = site.y; y < 8; y += 2) {
      for (int x = site.x; x < 8; x += 2) {
        image.data[static_cast<std::size_t>(y * 8 + x)] = 200;
      }
    }
    EXPECT_EQ(colourPixels(image).at<cv::Vec3b>(4, 4), cv::Vec3b(0, 0, 200)) << encoding;
    EXPECT_NEAR(greyPixels(image).at<std::uint8_t>(4, 4), 60, 1) << encoding;
  }
}

TEST(ImagePixelsTest, RefusesWhatIsNotDeblurred) {
  const sensor_msgs::Image image = imageOf("32FC1", std::vector<std::uint8_t>(8, 0));
  EXPECT_THROW(greyPixels(image), std::invalid_argument);
  EXPECT_THROW(colourPixels(image), std::invalid_argument);
}

TEST(ImagePixelsTest, MessagesHoldPackedRows) {
  std_msgs::Header header;
  header.frame_id = "camera";
  const cv::Mat wide(3, 5, CV_8UC3, cv::Scalar(1, 2, 3));
  const sensor_msgs::ImagePtr message = colourMessage(header, wide.colRange(1, 4));
  EXPECT_EQ(message->header.frame_id, "camera");
  EXPECT_EQ(message->encoding, "bgr8");
  EXPECT_EQ(message->height, 3U);
  EXPECT_EQ(message->width, 3U);
  EXPECT_EQ(message->step, 9U);
  ASSERT_EQ(message->data.size(), 27U);
  EXPECT_EQ(colourPixels(*message).at<cv::Vec3b>(2, 2), cv::Vec3b(1, 2, 3));
}

}  // namespace
}  // namespace fast_edi
