/// \file
/// A network that makes one image of another, such as a learned method of deblurring, by OpenCV's
/// dnn.
#pragma once

#include <string>

#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>

#include "networks/onnx_input.hpp"

namespace fast_edi {

/// What a network has for 0 and 255 DN, in and out.
struct NetworkRange {
  double black = 0.0;
  double white = 1.0;
};

/// "0:1". \throws std::invalid_argument unless both are numbers and differ
NetworkRange networkRange(const std::string& text);

/// Images are padded by reflection: to the size that the model asks for or, where that is any, to a
/// multiple of kNetworkMultiple_px. The output is cut back. Three channels in get the same grey; of
/// three out, the mean is taken.
constexpr int kNetworkMultiple_px = 32;  ///< enough for five times half the resolution

class SingleImageNetwork {
 public:
  /// \param path an ONNX file
  /// \throws std::runtime_error naming the file when it cannot be read, or is no network of one
  /// image with one or three channels
  SingleImageNetwork(std::string path, NetworkRange range);

  /// \param image CV_8UC1
  /// \return CV_8UC1 of the same size
  /// \throws std::runtime_error naming the file when \p image is larger than the model takes, or
  /// the output is no image of its input's size, or not finite
  cv::Mat run(const cv::Mat& image);

 private:
  cv::Size paddedSize(cv::Size size) const;
  cv::Mat forward(const cv::Mat& padded);

  std::string path_;
  NetworkRange range_;
  OnnxInput input_;
  cv::dnn::Net net_;
};

}  // namespace fast_edi
