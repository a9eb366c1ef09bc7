/// \file
/// Pixels of image messages as OpenCV matrices, for what looks at frames: detectors, pictures.
#pragma once

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

namespace fast_edi {

/// One channel of 8 bits: colour and Bayer frames turned to grey, 16 bits scaled down. Shares the
/// message's memory where nothing is to be converted, so \p message must outlive the result.
/// \pre readImage(message) finds it supported
cv::Mat greyPixels(const sensor_msgs::Image& message);

/// A copy as CV_8UC3 in OpenCV's order, blue first.
/// \pre readImage(message) finds it supported
cv::Mat colorPixels(const sensor_msgs::Image& message);

}  // namespace fast_edi
