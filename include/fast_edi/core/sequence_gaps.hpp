/// \file
/// Lost messages by the holes in header.seq.
#pragma once

#include <cstdint>
#include <optional>

namespace fast_edi {

/// A sequence number that is larger than the last one plus one tells of a gap, provided that the
/// numbers were growing. Equal, zero or smaller ones say nothing: within a nodelet manager every
/// message may carry the same number, and a publisher that starts anew begins from 0.
class SequenceGaps {
 public:
  /// \return true when messages are missing between the last call and this one
  bool isAfterGap(std::uint32_t sequence) {
    const bool grows = last_ && sequence > *last_;
    const bool gap = grows && growing_ && sequence - *last_ > 1;
    growing_ = grows;
    last_ = sequence;
    return gap;
  }
  void restart() {
    last_.reset();
    growing_ = false;
  }

 private:
  std::optional<std::uint32_t> last_;
  bool growing_ = false;
};

}  // namespace fast_edi
