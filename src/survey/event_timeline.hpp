/// \file
/// When events came: epochs between time jumps, counts over time, pauses, and events out of order.
#pragma once

#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Events between two time jumps.
struct EventEpoch {
  static constexpr std::int64_t kBin_ns = kNanosecondsPerMillisecond;

  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::uint64_t events = 0;
  std::vector<std::uint32_t> bins;       ///< events of each millisecond from first_ns on
  std::vector<ExposureInterval> pauses;  ///< longer than EventTimeline::kLeastPause_ns

  /// Events in an interval, to the millisecond.
  std::uint64_t count(const ExposureInterval& interval) const;
  bool contains(const ExposureInterval& interval) const {
    return interval.start_ns >= first_ns && interval.end_ns <= last_ns;
  }
};

class EventTimeline {
 public:
  /// Shorter pauses are not kept.
  static constexpr std::int64_t kLeastPause_ns = 2 * kNanosecondsPerMillisecond;
  static constexpr std::int64_t kMaxBackwardJump_ns = 500 * kNanosecondsPerMillisecond;
  static constexpr std::int64_t kMaxForwardJump_ns = 10 * kNanosecondsPerSecond;
  /// Stamps before this are not those of a clock that was set: a year after 1970.
  static constexpr std::int64_t kEarliest_ns = 365LL * 24 * 3600 * kNanosecondsPerSecond;

  void add(std::int64_t t_ns);

  const std::vector<EventEpoch>& epochs() const { return epochs_; }
  /// The one with most events; null without events.
  const EventEpoch* longestEpoch() const;
  std::uint64_t events() const { return events_; }
  std::uint64_t unordered() const { return unordered_; }  ///< earlier than their predecessor
  std::int64_t largestStepBack() const { return largest_step_back_ns_; }
  std::uint64_t backwardJumps() const { return backward_jumps_; }
  std::uint64_t forwardJumps() const { return forward_jumps_; }
  std::int64_t largestJump() const { return largest_jump_ns_; }
  /// Of the first jump.
  std::int64_t firstJumpTo() const { return first_jump_to_ns_; }

 private:
  void beginEpoch(std::int64_t t_ns);

  std::vector<EventEpoch> epochs_;
  std::uint64_t events_ = 0;
  std::uint64_t unordered_ = 0;
  std::int64_t largest_step_back_ns_ = 0;
  std::uint64_t backward_jumps_ = 0;
  std::uint64_t forward_jumps_ = 0;
  std::int64_t largest_jump_ns_ = 0;
  std::int64_t first_jump_to_ns_ = 0;
};

}  // namespace fast_edi
