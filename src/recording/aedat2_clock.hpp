/// \file
#pragma once

#include <algorithm>
#include <cstdint>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Times of AEDAT2, which have 32 bits and wrap around every 71 minutes.
class Aedat2Clock {
 public:
  /// A time that comes next, without wrapping around [us].
  std::int64_t unwrapped(std::uint32_t t_us) const {
    constexpr std::uint32_t kHalf = 1U << 31;
    const bool wrapped = t_us < last_us_ && last_us_ - t_us > kHalf && high_us_ < kMaxWraps;
    return ((high_us_ + (wrapped ? 1 : 0)) << 32) + t_us;
  }

  /// Goes on to a time of unwrapped().
  void advance(std::int64_t t_us) {
    high_us_ = t_us >> 32;
    last_us_ = static_cast<std::uint32_t>(t_us);
    latest_ns_ = std::max(latest_ns_, t_us * kNanosecondsPerMicrosecond);
  }

  /// The latest time so far [ns].
  std::int64_t latest() const { return latest_ns_; }

 private:
  static constexpr std::int64_t kMaxWraps = 1000;  ///< more is damage

  std::int64_t high_us_ = 0;  ///< how often times have wrapped around
  std::uint32_t last_us_ = 0;
  std::int64_t latest_ns_ = 0;
};

}  // namespace fast_edi
