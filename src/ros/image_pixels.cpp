#include "fast_edi/ros/image_pixels.hpp"

#include <cstdint>

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

}  // namespace

cv::Mat greyPixels(const sensor_msgs::Image& message) {
  // Not by cv_bridge, which takes 8UC1 for a matrix without colour.
  return isGrey(message) ? sharedGrey(message)
                         : cv_bridge::toCvCopy(message, encodings::MONO8)->image;
}

cv::Mat colorPixels(const sensor_msgs::Image& message) {
  if (!isGrey(message)) {
    return cv_bridge::toCvCopy(message, encodings::BGR8)->image;
  }
  cv::Mat color;
  cv::cvtColor(sharedGrey(message), color, cv::COLOR_GRAY2BGR);
  return color;
}

}  // namespace fast_edi
