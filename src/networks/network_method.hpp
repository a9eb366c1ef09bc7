/// \file
#pragma once

#include <string>
#include <utility>

#include "evaluation/other_method.hpp"
#include "evaluation/pipeline.hpp"
#include "networks/single_image_network.hpp"

namespace fast_edi {

/// A network as a method under comparison.
class NetworkMethod : public OtherMethod {
 public:
  /// \throws std::runtime_error, see SingleImageNetwork
  NetworkMethod(std::string name, std::string path, NetworkRange range)
      : name_(std::move(name)), network_(std::move(path), range) {}

  std::string name() const override { return name_; }
  Result deblur(const Frame& frame) override {
    const auto start = std::chrono::steady_clock::now();
    cv::Mat image = network_.run(frame.blurry);
    return {image, millisecondsSince(start)};
  }

 private:
  std::string name_;
  SingleImageNetwork network_;
};

}  // namespace fast_edi
