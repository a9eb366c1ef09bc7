#include "fast_edi/messages/image_pixels.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <sensor_msgs/fill_image.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>
#include <opencv2/imgproc.hpp>

#include "fast_edi/base/image.hpp"

// By OpenCV alone: cv_bridge brings imgcodecs, and on Debian with it GDAL and a hundred libraries
// more, which cost a nodelet manager over 30 MB.

namespace fast_edi {
namespace {

constexpr int kAsItIs = -1;

/// How OpenCV sees the pixels of an encoding.
struct Conversion {
  const char* encoding;
  int samples;
  int bytes;    ///< of a sample
  int to_grey;  ///< code of cv::cvtColor
  int to_colour;
};

/// OpenCV names Bayer patterns by the second row's second and third pixel.
constexpr std::array<Conversion, 19> kConversions{{
    {"mono8", 1, 1, kAsItIs, cv::COLOR_GRAY2BGR},
    {"8UC1", 1, 1, kAsItIs, cv::COLOR_GRAY2BGR},
    {"mono16", 1, 2, kAsItIs, cv::COLOR_GRAY2BGR},
    {"rgb8", 3, 1, cv::COLOR_RGB2GRAY, cv::COLOR_RGB2BGR},
    {"bgr8", 3, 1, cv::COLOR_BGR2GRAY, kAsItIs},
    {"rgba8", 4, 1, cv::COLOR_RGBA2GRAY, cv::COLOR_RGBA2BGR},
    {"bgra8", 4, 1, cv::COLOR_BGRA2GRAY, cv::COLOR_BGRA2BGR},
    {"rgb16", 3, 2, cv::COLOR_RGB2GRAY, cv::COLOR_RGB2BGR},
    {"bgr16", 3, 2, cv::COLOR_BGR2GRAY, kAsItIs},
    {"rgba16", 4, 2, cv::COLOR_RGBA2GRAY, cv::COLOR_RGBA2BGR},
    {"bgra16", 4, 2, cv::COLOR_BGRA2GRAY, cv::COLOR_BGRA2BGR},
    {"bayer_rggb8", 1, 1, cv::COLOR_BayerBG2GRAY, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr8", 1, 1, cv::COLOR_BayerRG2GRAY, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg8", 1, 1, cv::COLOR_BayerGR2GRAY, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg8", 1, 1, cv::COLOR_BayerGB2GRAY, cv::COLOR_BayerGB2BGR},
    {"bayer_rggb16", 1, 2, cv::COLOR_BayerBG2GRAY, cv::COLOR_BayerBG2BGR},
    {"bayer_bggr16", 1, 2, cv::COLOR_BayerRG2GRAY, cv::COLOR_BayerRG2BGR},
    {"bayer_gbrg16", 1, 2, cv::COLOR_BayerGR2GRAY, cv::COLOR_BayerGR2BGR},
    {"bayer_grbg16", 1, 2, cv::COLOR_BayerGB2GRAY, cv::COLOR_BayerGB2BGR},
}};

const Conversion& conversionOf(const std::string& encoding) {
  const auto* found =
      std::find_if(kConversions.begin(), kConversions.end(),
                   [&](const Conversion& known) { return encoding == known.encoding; });
  if (found == kConversions.end()) {
    throw std::invalid_argument("no conversion of pixels for encoding \"" + encoding + "\"");
  }
  return *found;
}

/// The message's own memory; 16 bits are scaled down to 8.
cv::Mat eightBits(const sensor_msgs::Image& message, const Conversion& conversion) {
  // As bytes, since OpenCV wants rows of wider numbers to begin at even addresses. It takes a
  // non-const buffer; nobody writes to this one.
  cv::Mat shared(static_cast<int>(message.height), static_cast<int>(message.width),
                 CV_8UC(conversion.samples * conversion.bytes),
                 const_cast<std::uint8_t*>(message.data.data()), message.step);
  if (conversion.bytes == 1) {
    return shared;
  }
  const cv::Mat packed = shared.clone();
  cv::Mat scaled;
  cv::Mat(packed.size(), CV_16UC(conversion.samples), packed.data)
      .convertTo(scaled, CV_8U, 1.0 / kDn16PerDn8);
  return scaled;
}

}  // namespace

cv::Mat greyPixels(const sensor_msgs::Image& message) {
  const Conversion& conversion = conversionOf(message.encoding);
  cv::Mat pixels = eightBits(message, conversion);
  if (conversion.to_grey == kAsItIs) {
    return pixels;
  }
  cv::Mat grey;
  cv::cvtColor(pixels, grey, conversion.to_grey);
  return grey;
}

cv::Mat colourPixels(const sensor_msgs::Image& message) {
  const Conversion& conversion = conversionOf(message.encoding);
  cv::Mat pixels = eightBits(message, conversion);
  if (conversion.to_colour == kAsItIs) {
    return pixels.clone();
  }
  cv::Mat colour;
  cv::cvtColor(pixels, colour, conversion.to_colour);
  return colour;
}

sensor_msgs::ImagePtr colourMessage(const std_msgs::Header& header, const cv::Mat& colour) {
  auto message = boost::make_shared<sensor_msgs::Image>();
  message->header = header;
  const auto rows = static_cast<std::uint32_t>(colour.rows);
  const auto columns = static_cast<std::uint32_t>(colour.cols);
  const cv::Mat packed = colour.isContinuous() ? colour : colour.clone();
  sensor_msgs::fillImage(*message, sensor_msgs::image_encodings::BGR8, rows, columns,
                         columns * static_cast<std::uint32_t>(colour.elemSize()), packed.data);
  return message;
}

}  // namespace fast_edi
