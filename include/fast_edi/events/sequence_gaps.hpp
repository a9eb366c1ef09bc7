/// \file
/// Lost messages by the holes in header.seq.
#pragma once

#include <cstdint>
#include <optional>

namespace fast_edi {

/// What a sequence number says about messages between the last one and this one.
enum class SequenceStep {
  kNothingMissing,  ///< or nothing known
  kGap,             ///< messages were lost on the way
  kRestart,         ///< the publisher was restarted: there is a time in which it published nothing
};

/// Increasing numbers with some left out mean a gap, increasing numbers that fall mean
/// a publisher that was restarted, from 0 or 1. Otherwise they say nothing: within a nodelet
/// manager every message may carry the same number.
class SequenceGaps {
 public:
  SequenceStep step(std::uint32_t sequence) {
    const bool grows = last_ && sequence > *last_;
    const bool wraps = last_ && *last_ == UINT32_MAX;
    SequenceStep step = SequenceStep::kNothingMissing;
    missing_ = 0;
    if (growing_ && grows && sequence - *last_ > 1) {
      missing_ = sequence - *last_ - 1;
      step = SequenceStep::kGap;
    } else if (growing_ && sequence < *last_ && !wraps) {
      step = SequenceStep::kRestart;
    }
    growing_ = grows;
    last_ = sequence;
    return step;
  }
  /// Whether the last message had this number, as far as that is known.
  bool isLast(std::uint32_t sequence) const { return last_ == sequence; }
  /// Messages that the last step left out.
  std::uint32_t missing() const { return missing_; }
  void restart() {
    last_.reset();
    growing_ = false;
  }

 private:
  std::optional<std::uint32_t> last_;
  bool growing_ = false;
  std::uint32_t missing_ = 0;
};

}  // namespace fast_edi
