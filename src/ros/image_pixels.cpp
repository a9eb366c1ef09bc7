#include "fast_edi/ros/image_pixels.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

#include <cv_bridge/cv_bridge.h>
#include <sensor_msgs/image_encodings.h>
#include <opencv2/imgproc.hpp>

namespace fast_edi {
namespace {

namespace encodings = sensor_msgs::image_encodings;

bool isGrey(const sensor_msgs::Image& message) {
  return message.encoding == encodings::MONO8 || message.encoding == encodings::TYPE_8UC1;
}

cv::Mat sharedGrey(const sensor_msgs::Image& message) {
  // OpenCV takes a non-const buffer; nobody writes to this one.
  return {static_cast<int>(message.height), static_cast<int>(message.width), CV_8UC1,
          const_cast<std::uint8_t*>(message.data.data()), message.step};
}

/// By cv_bridge, which wants rows that fill the message exactly, of whole pixels with their
/// padding; that of the last row may be missing.
cv::Mat converted(const sensor_msgs::Image& message, const std::string& encoding) {
  const auto row_bytes = static_cast<std::size_t>(static_cast<int>(message.width) *
                                                  encodings::numChannels(message.encoding) *
                                                  encodings::bitDepth(message.encoding) / 8);
  if (message.step == row_bytes && message.data.size() == row_bytes * message.height) {
    return cv_bridge::toCvCopy(message, encoding)->image;
  }
  sensor_msgs::Image packed;
  packed.header = message.header;
  packed.height = message.height;
  packed.width = message.width;
  packed.encoding = message.encoding;
  packed.is_bigendian = message.is_bigendian;
  packed.step = static_cast<std::uint32_t>(row_bytes);
  for (std::uint32_t y = 0; y < message.height; ++y) {
    const std::uint8_t* row = message.data.data() + std::size_t{message.step} * y;
    packed.data.insert(packed.data.end(), row, row + row_bytes);
  }
  return cv_bridge::toCvCopy(packed, encoding)->image;
}

}  // namespace

cv::Mat greyPixels(const sensor_msgs::Image& message) {
  // Not by cv_bridge, which takes 8UC1 for a matrix without colour.
  return isGrey(message) ? sharedGrey(message) : converted(message, encodings::MONO8);
}

cv::Mat colorPixels(const sensor_msgs::Image& message) {
  if (!isGrey(message)) {
    return converted(message, encodings::BGR8);
  }
  cv::Mat color;
  cv::cvtColor(sharedGrey(message), color, cv::COLOR_GRAY2BGR);
  return color;
}

}  // namespace fast_edi
