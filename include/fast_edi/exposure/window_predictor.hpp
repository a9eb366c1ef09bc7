/// \file
/// Predicts the next exposure of a periodic camera, so that its events can be integrated as they
/// arrive. A wrong prediction costs time, never correctness.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

class WindowPredictor {
 public:
  /// Two starts further apart say nothing about the frame rate.
  static constexpr std::int64_t kMaxPeriod_ns = kNanosecondsPerSecond;

  /// An exposure that was, in the order of frames.
  void observe(const ExposureInterval& exposure);
  /// Discards all observations: the frames' clock jumped.
  void reset();

  /// The last start plus the period, with the last length. The period is the median of the last
  /// three, so that one lost frame does not spoil the predictions after it.
  std::optional<ExposureInterval> predict() const;
  /// The last length, 0 when there was none.
  std::int64_t lastLength() const { return last_ ? last_->length() : 0; }

 private:
  static constexpr std::size_t kPeriods = 3;

  std::optional<ExposureInterval> last_;
  std::array<std::int64_t, kPeriods> periods_ns_{};
  std::size_t period_count_ = 0;
};

}  // namespace fast_edi
