/// \file
/// Pixels of image messages as OpenCV matrices and back, for what looks at frames: detectors,
/// pictures.
#pragma once

#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>
#include <opencv2/core.hpp>

namespace fast_edi {

/// One channel of 8 bits: colour and Bayer frames turned to grey, 16 bits scaled down. Shares the
/// message's memory where nothing is to be converted, so \p message must outlive the result.
/// \throws std::invalid_argument for an encoding that readImage() does not find supported
cv::Mat greyPixels(const sensor_msgs::Image& message);

/// A copy as CV_8UC3 in OpenCV's order, blue first.
/// \throws std::invalid_argument for an encoding that readImage() does not find supported
cv::Mat colourPixels(const sensor_msgs::Image& message);

/// A bgr8 message.
/// \param colour CV_8UC3
sensor_msgs::ImagePtr colourMessage(const std_msgs::Header& header, const cv::Mat& colour);

}  // namespace fast_edi
