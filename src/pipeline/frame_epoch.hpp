/// \file
/// The clock of the input frames: their stamps grow within an epoch, and a jump back begins a new
/// one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace fast_edi {

class FrameEpoch {
 public:
  /// \return true when the stamp lies so far back that a new epoch begins with it
  bool jumpsBack(std::int64_t stamp_ns, std::int64_t max_backward_jump_ns) const {
    return latest_stamp_ns_ && stamp_ns < *latest_stamp_ns_ - max_backward_jump_ns;
  }
  /// A frame of this epoch.
  void observe(std::int64_t stamp_ns) {
    latest_stamp_ns_ = std::max(latest_stamp_ns_.value_or(stamp_ns), stamp_ns);
  }
  void begin(bool after_time_jump) {
    ++number_;
    after_time_jump_ = after_time_jump;
    latest_stamp_ns_.reset();
  }

  std::uint64_t number() const { return number_; }
  /// True when this epoch began with a jump back.
  bool afterTimeJump() const { return after_time_jump_; }

 private:
  std::uint64_t number_ = 0;
  bool after_time_jump_ = false;
  std::optional<std::int64_t> latest_stamp_ns_;
};

/// Stamps of the output, which increase strictly within an epoch.
class OutputOrder {
 public:
  bool isLater(std::uint64_t epoch, std::int64_t stamp_ns) const {
    return epoch != epoch_ || !last_ns_ || stamp_ns > *last_ns_;
  }
  void observe(std::uint64_t epoch, std::int64_t stamp_ns) {
    epoch_ = epoch;
    last_ns_ = stamp_ns;
  }

 private:
  std::uint64_t epoch_ = 0;
  std::optional<std::int64_t> last_ns_;
};

}  // namespace fast_edi
