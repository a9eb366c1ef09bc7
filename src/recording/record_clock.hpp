/// \file
/// When the items of a recording were recorded, by their own times.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Follows times that go on, but for single wrong ones: a time far ahead of all before it counts
/// only once the next one lies there, too. Times that go back do not count.
class RecordClock {
 public:
  /// A time is far ahead by more.
  static constexpr std::int64_t kMaxStep_ns = 10 * kNanosecondsPerSecond;

  /// The next time. \return when it was recorded, which never goes back
  std::int64_t advance(std::int64_t t_ns) {
    const bool confirms =
        ahead_ns_ && t_ns - *ahead_ns_ >= -kMaxStep_ns && t_ns - *ahead_ns_ <= kMaxStep_ns;
    refuted_ns_.reset();
    if (!latest_ns_ || confirms || t_ns - *latest_ns_ <= kMaxStep_ns) {
      if (!confirms) {
        refute();
      }
      ahead_ns_.reset();
      latest_ns_ = std::max(latest_ns_.value_or(t_ns), t_ns);
    } else {
      refute();
      ahead_ns_ = t_ns;
    }
    return *latest_ns_;
  }
  /// Whether the last time lies far ahead, and waits for the next one.
  bool isAhead() const { return ahead_ns_.has_value(); }
  /// By how much the time before the last one was wrong, if it was.
  std::optional<std::int64_t> refutedBy() const { return refuted_ns_; }

 private:
  void refute() {
    if (ahead_ns_) {
      refuted_ns_ = *ahead_ns_ - *latest_ns_;
    }
  }

  std::optional<std::int64_t> latest_ns_;
  std::optional<std::int64_t> ahead_ns_;  ///< not confirmed so far
  std::optional<std::int64_t> refuted_ns_;
};

}  // namespace fast_edi
