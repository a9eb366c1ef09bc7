#include "fast_edi/messages/message_conversion.hpp"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

sensor_msgs::Image makeImage(const std::string& encoding, std::uint32_t width, std::uint32_t height,
                             std::uint32_t step) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(5, 6);
  image.header.frame_id = "camera";
  image.encoding = encoding;
  image.width = width;
  image.height = height;
  image.step = step;
  image.data.resize(static_cast<std::size_t>(step) * height);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>(i);
  }
  return image;
}

struct EncodingCase {
  const char* encoding;
  PixelFormat format;
};

class SupportedEncoding : public ::testing::TestWithParam<EncodingCase> {};

TEST_P(SupportedEncoding, IsReadInPlaceAndWrittenWithoutPadding) {
  const EncodingCase& c = GetParam();
  const auto row_bytes = static_cast<std::uint32_t>(4 * bytesPerPixel(c.format));
  const sensor_msgs::Image image = makeImage(c.encoding, 4, 3, row_bytes + 2);
  const ImageReading reading = readImage(image);
  ASSERT_EQ(reading.verdict, ImageVerdict::kSupported) << reading.reason;
  EXPECT_EQ(reading.view.data, image.data.data());
  EXPECT_EQ(reading.view.size, (SensorSize{4, 3}));
  EXPECT_EQ(reading.view.step, row_bytes + 2);
  EXPECT_EQ(reading.view.format, c.format);

  const sensor_msgs::ImagePtr out = makeImageLike(image, c.format);
  EXPECT_EQ(out->encoding, c.encoding);
  EXPECT_EQ(out->step, row_bytes);
  EXPECT_EQ(out->data.size(), row_bytes * 3);
  EXPECT_EQ(out->header.frame_id, "camera");
  const MutableImageView view = viewOf(*out, c.format);
  EXPECT_EQ(view.data, out->data.data());
  EXPECT_EQ(view.size, (SensorSize{4, 3}));
  EXPECT_EQ(readImage(*out).verdict, ImageVerdict::kSupported);
}

INSTANTIATE_TEST_SUITE_P(All, SupportedEncoding,
                         ::testing::Values(EncodingCase{"mono8", PixelFormat::kMono8},
                                           EncodingCase{"8UC1", PixelFormat::kMono8},
                                           EncodingCase{"bayer_rggb8", PixelFormat::kBayer8},
                                           EncodingCase{"bayer_bggr8", PixelFormat::kBayer8},
                                           EncodingCase{"bayer_gbrg8", PixelFormat::kBayer8},
                                           EncodingCase{"bayer_grbg8", PixelFormat::kBayer8},
                                           EncodingCase{"mono16", PixelFormat::kMono16},
                                           EncodingCase{"rgb8", PixelFormat::kColour8},
                                           EncodingCase{"bgr8", PixelFormat::kColour8},
                                           EncodingCase{"rgba8", PixelFormat::kColourAlpha8},
                                           EncodingCase{"bgra8", PixelFormat::kColourAlpha8},
                                           EncodingCase{"rgb16", PixelFormat::kColour16},
                                           EncodingCase{"bgr16", PixelFormat::kColour16},
                                           EncodingCase{"rgba16", PixelFormat::kColourAlpha16},
                                           EncodingCase{"bgra16", PixelFormat::kColourAlpha16},
                                           EncodingCase{"bayer_rggb16", PixelFormat::kBayer16},
                                           EncodingCase{"bayer_bggr16", PixelFormat::kBayer16},
                                           EncodingCase{"bayer_gbrg16", PixelFormat::kBayer16},
                                           EncodingCase{"bayer_grbg16", PixelFormat::kBayer16}));

TEST(ReadImage, NamesAnEncodingThatIsNotDeblurred) {
  for (const char* encoding : {"32FC1", "yuv422", "16UC1", ""}) {
    const ImageReading reading = readImage(makeImage(encoding, 4, 3, 16));
    EXPECT_EQ(reading.verdict, ImageVerdict::kUnsupported);
    EXPECT_THAT(reading.reason, HasSubstr("\"" + std::string(encoding) + "\""));
    EXPECT_THAT(reading.reason, HasSubstr("expected mono8"));
    EXPECT_EQ(reading.view.data, nullptr);
  }
}

TEST(ReadImage, LeavesBigEndianNumbersOf16BitsAlone) {
  for (const char* encoding : {"mono16", "rgb16", "bgra16", "bayer_grbg16"}) {
    sensor_msgs::Image image = makeImage(encoding, 4, 3, 32);
    image.is_bigendian = 1;
    EXPECT_EQ(readImage(image).verdict, ImageVerdict::kUnsupported);
    EXPECT_THAT(readImage(image).reason, HasSubstr(std::string(encoding) + " in big-endian"));
  }
  sensor_msgs::Image bytes = makeImage("bgra8", 4, 3, 16);
  bytes.is_bigendian = 1;
  EXPECT_EQ(readImage(bytes).verdict, ImageVerdict::kSupported);
}

TEST(ReadImage, RefusesLengthsThatContradictEachOther) {
  sensor_msgs::Image image = makeImage("mono8", 4, 3, 4);
  image.step = 3;
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kMalformed);
  EXPECT_THAT(readImage(image).reason, HasSubstr("step 3"));

  image = makeImage("mono8", 4, 3, 4);
  image.data.pop_back();
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kMalformed);
  EXPECT_THAT(readImage(image).reason, HasSubstr("11 bytes of data, expected at least 12"));

  image = makeImage("mono8", 4, 3, 4);
  image.height = 0;
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kMalformed);

  // In 32 bits step * height is 0 here.
  image = makeImage("mono8", 4, 3, 4);
  image.step = 0x80000000u;
  image.height = 2;
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kMalformed);

  image = makeImage("mono8", 4, 3, 4);
  image.height = 1'000'000;
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kMalformed);

  image = makeImage("rgb8", 4, 3, 12);
  image.step = 11;
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kMalformed);
}

TEST(ReadImage, DoesNotAskForPaddingAfterTheLastRow) {
  sensor_msgs::Image image = makeImage("mono8", 4, 3, 6);
  image.data.resize(16);
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kSupported);
  image.data.resize(15);
  EXPECT_EQ(readImage(image).verdict, ImageVerdict::kMalformed);
}

TEST(ReadImage, PassesOnWhatNoSensorCanBe) {
  EXPECT_EQ(readImage(makeImage("mono8", 32768, 1, 32768)).verdict, ImageVerdict::kUnsupported);
  EXPECT_EQ(readImage(makeImage("mono8", 32767, 1, 32767)).verdict, ImageVerdict::kSupported);
}

TEST(MakeCameraInfo, CopiesTheCalibrationWithTheImagesHeader) {
  sensor_msgs::CameraInfo latest;
  latest.width = 4;
  latest.height = 3;
  latest.K[0] = 250.0;
  latest.distortion_model = "plumb_bob";
  const sensor_msgs::Image image = makeImage("mono8", 4, 3, 4);
  const sensor_msgs::CameraInfoPtr info = makeCameraInfo(&latest, image);
  EXPECT_EQ(info->header.stamp, image.header.stamp);
  EXPECT_EQ(info->header.frame_id, "camera");
  EXPECT_EQ(info->K[0], 250.0);
  EXPECT_EQ(info->distortion_model, "plumb_bob");
}

TEST(MakeCameraInfo, SaysUncalibratedWhenNoneWasReceived) {
  const sensor_msgs::CameraInfoPtr info = makeCameraInfo(nullptr, makeImage("mono8", 4, 3, 4));
  EXPECT_EQ(info->width, 4u);
  EXPECT_EQ(info->height, 3u);
  EXPECT_EQ(info->K[0], 0.0);
  EXPECT_EQ(info->header.stamp, ros::Time(5, 6));
}

TEST(CameraInfoFault, FindsNumbersThatAreNotFinite) {
  sensor_msgs::CameraInfo info;
  EXPECT_EQ(cameraInfoFault(info), "");  // not calibrated
  info.D = {0.1, 0.2};
  info.K[0] = 200.0;
  EXPECT_EQ(cameraInfoFault(info), "");
  info.P[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(cameraInfoFault(info), "P holds a number that is not finite");
  info.D[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(cameraInfoFault(info), "D holds a number that is not finite");
}

}  // namespace
}  // namespace fast_edi
