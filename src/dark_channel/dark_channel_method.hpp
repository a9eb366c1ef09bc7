/// \file
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "dark_channel/blind_deblurring.hpp"
#include "evaluation/other_method.hpp"
#include "evaluation/pipeline.hpp"

namespace fast_edi {

/// The dark channel prior as a method under comparison.
class DarkChannelMethod : public OtherMethod {
 public:
  using Progress = std::function<void(double)>;  ///< called with 0 to 1 for each frame

  /// \throws std::invalid_argument naming the option that is out of range
  DarkChannelMethod(const BlindDeblurringOptions& options, Progress progress)
      : options_(options), progress_(std::move(progress)) {
    options_.validate();
  }

  std::string name() const override { return "dark channel"; }
  Result deblur(const Frame& frame) override {
    const auto start = std::chrono::steady_clock::now();
    cv::Mat image = deblurBlindly(frame.blurry, options_, progress_).image;
    return {image, millisecondsSince(start)};
  }

 private:
  BlindDeblurringOptions options_;
  Progress progress_;
};

}  // namespace fast_edi
