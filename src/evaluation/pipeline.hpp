/// \file
/// A Deblurrer as a method under comparison: with a queue behind it, and a clock around it.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <utility>

#include <opencv2/core.hpp>

#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi {

inline double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

inline ImageView viewOf(const cv::Mat& image) {
  return {image.data, {image.cols, image.rows}, image.step[0], PixelFormat::kMono8};
}

inline MutableImageView mutableViewOf(cv::Mat& image) {
  return {image.data, {image.cols, image.rows}, image.step[0], PixelFormat::kMono8};
}

class Pipeline : public FrameSink {
 public:
  struct Finished {
    OutputFrame output;
    cv::Mat image;
    double runtime_ms = 0.0;
  };

  explicit Pipeline(const DeblurParameters& parameters) : deblurrer_(parameters, *this) {}

  template <typename Call>
  void run(Call call) {
    call_start_ = std::chrono::steady_clock::now();
    call(deblurrer_);
    spent_ms_ += millisecondsSince(call_start_);
  }

  MutableImageView begin(const InputFrame& input) override {
    image_ = cv::Mat(input.image.size.height, input.image.size.width, CV_8UC1);
    return mutableViewOf(image_);
  }

  void finish(const OutputFrame& output) override {
    finished_.push_back({output, image_, spent_ms_ + millisecondsSince(call_start_)});
    spent_ms_ = 0.0;
    call_start_ = std::chrono::steady_clock::now();
  }

  bool hasFinished() const { return !finished_.empty(); }
  Finished take() {
    Finished front = std::move(finished_.front());
    finished_.pop_front();
    return front;
  }
  const DeblurCounters& counters() const { return deblurrer_.counters(); }

 private:
  cv::Mat image_;
  std::deque<Finished> finished_;
  std::chrono::steady_clock::time_point call_start_;
  double spent_ms_ = 0.0;
  Deblurrer deblurrer_;
};

/// A frame for any number of pipelines, with its own copy of the pixels.
/// \param image CV_8UC1; empty: an encoding that is not deblurred
inline InputFrame inputFrame(std::int64_t stamp_ns, const cv::Mat& image) {
  InputFrame frame;
  frame.stamp_ns = stamp_ns;
  frame.supported = !image.empty();
  if (frame.supported) {
    const auto owner = std::make_shared<const cv::Mat>(image.clone());
    frame.image = viewOf(*owner);
    frame.owner = owner;
  }
  return frame;
}

}  // namespace fast_edi
