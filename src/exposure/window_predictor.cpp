#include "fast_edi/exposure/window_predictor.hpp"

#include <algorithm>

namespace fast_edi {

void WindowPredictor::observe(const ExposureInterval& exposure) {
  if (last_) {
    const std::int64_t period_ns = exposure.start_ns - last_->start_ns;
    if (period_ns > 0 && period_ns <= kMaxPeriod_ns) {
      periods_ns_[period_count_ % kPeriods] = period_ns;
      ++period_count_;
    } else {
      period_count_ = 0;
    }
  }
  last_ = exposure;
}

void WindowPredictor::reset() {
  last_.reset();
  period_count_ = 0;
}

std::optional<ExposureInterval> WindowPredictor::predict() const {
  if (period_count_ == 0) {
    return std::nullopt;
  }
  std::array<std::int64_t, kPeriods> sorted = periods_ns_;
  const std::size_t count = std::min(period_count_, kPeriods);
  const auto median = sorted.begin() + (count - 1) / 2;
  std::nth_element(sorted.begin(), median, sorted.begin() + count);
  const std::int64_t start_ns = last_->start_ns + *median;
  return ExposureInterval{start_ns, start_ns + last_->length()};
}

}  // namespace fast_edi
