/// \file
/// Methods beside those of MethodComparison: what sees the blurry frame alone, or ran elsewhere.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

class OtherMethod {
 public:
  struct Frame {
    std::int64_t stamp_ns = 0;        ///< of the latent image, by the parameter `reference`
    std::int64_t input_stamp_ns = 0;  ///< of the frame as recorded
    cv::Mat blurry;                   ///< CV_8UC1
  };
  struct Result {
    cv::Mat image;            ///< CV_8UC1 of the frame's size; empty: none for this frame
    double runtime_ms = 0.0;  ///< wall clock; 0: not computed here
  };

  OtherMethod() = default;
  virtual ~OtherMethod() = default;
  OtherMethod(const OtherMethod&) = delete;
  OtherMethod& operator=(const OtherMethod&) = delete;

  /// For tables.
  virtual std::string name() const = 0;
  /// Called for each frame that is scored, in their order.
  /// \throws std::runtime_error naming the method and what is wrong
  virtual Result deblur(const Frame& frame) = 0;
  /// What the reader of a report must know, after the last frame; one line each.
  virtual std::vector<std::string> notes() const { return {}; }
};

using OtherMethods = std::vector<std::unique_ptr<OtherMethod>>;

}  // namespace fast_edi
