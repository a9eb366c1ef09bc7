#include "pictures/picture.hpp"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

std::vector<std::uint8_t> encoded(const std::string& extension, const cv::Mat& pixels) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, pixels, bytes);
  return bytes;
}

cv::Mat noise(int type) {
  cv::Mat pixels(13, 17, type);
  cv::randu(pixels, 0, 200);
  return pixels;
}

TEST(Picture, PngComesBackBitForBit) {
  for (const auto& [type, encoding] :
       {std::pair(CV_8UC1, "mono8"), {CV_16UC1, "mono16"}, {CV_8UC3, "bgr8"}, {CV_8UC4, "bgra8"}}) {
    const cv::Mat pixels = noise(type);
    const std::vector<std::uint8_t> bytes = encoded(".png", pixels);
    std::string fault;
    const std::optional<Picture> picture = decodePicture(bytes.data(), bytes.size(), fault);
    ASSERT_TRUE(picture) << fault;
    EXPECT_EQ(picture->encoding, encoding);
    EXPECT_EQ(picture->size, (SensorSize{17, 13}));
    EXPECT_EQ(picture->pixels, std::vector<std::uint8_t>(pixels.datastart, pixels.dataend));
  }
}

TEST(Picture, JpegIsMeasuredByItsHeader) {
  const std::vector<std::uint8_t> bytes = encoded(".jpg", noise(CV_8UC3));
  EXPECT_EQ(pictureSize(bytes.data(), bytes.size()), (SensorSize{17, 13}));
  std::string fault;
  EXPECT_TRUE(decodePicture(bytes.data(), bytes.size(), fault)) << fault;
}

TEST(Picture, ChannelsComeInTheOrderOfTheEncoding) {
  const cv::Mat pixels(1, 1, CV_8UC3, cv::Scalar(1, 2, 3));  // blue, green, red
  const std::vector<std::uint8_t> bytes = encoded(".png", pixels);
  std::string fault;
  Picture picture = *decodePicture(bytes.data(), bytes.size(), fault);
  ASSERT_TRUE(convertPicture(picture, "rgb8", false));
  EXPECT_EQ(picture.encoding, "rgb8");
  EXPECT_EQ(picture.pixels, (std::vector<std::uint8_t>{3, 2, 1}));
  EXPECT_FALSE(convertPicture(picture, "mono8", false));
  EXPECT_FALSE(convertPicture(picture, "rgb16", false));
  EXPECT_FALSE(convertPicture(picture, "rgba8", false));
}

TEST(Picture, OfRawBayerIsKeptAsItIs) {
  const cv::Mat pixels = noise(CV_8UC1);
  const std::vector<std::uint8_t> bytes = encoded(".png", pixels);
  std::string fault;
  Picture picture = *decodePicture(bytes.data(), bytes.size(), fault);
  const std::vector<std::uint8_t> before = picture.pixels;
  ASSERT_TRUE(convertPicture(picture, "bayer_rggb8", false));
  EXPECT_EQ(picture.pixels, before);
}

TEST(Picture, OfGigabytesIsRefusedByItsHeader) {
  std::vector<std::uint8_t> bytes = encoded(".png", noise(CV_8UC1));
  bytes[16] = 0x7f;  // the width
  std::string fault;
  EXPECT_FALSE(decodePicture(bytes.data(), bytes.size(), fault));
  EXPECT_THAT(fault, HasSubstr("expected at most 16777216"));
}

TEST(Picture, CutAnywhereIsNoneOrHasItsSize) {
  for (const char* extension : {".png", ".jpg"}) {
    const std::vector<std::uint8_t> bytes = encoded(extension, noise(CV_8UC1));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      std::string fault;
      const std::optional<Picture> picture = decodePicture(bytes.data(), size, fault);
      EXPECT_EQ(fault.empty(), picture.has_value());
      if (picture) {
        EXPECT_EQ(picture->size, (SensorSize{17, 13}));
      }
    }
  }
}

}  // namespace
}  // namespace fast_edi
