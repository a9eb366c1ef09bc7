/// \file
/// For which times all events are known to have come in.
///
/// Missing are: everything before the stream's start (or its new start after a flush), what was
/// discarded, and holes where event arrays were lost. What lies after the newest event counts as
/// covered: events that are still to come are waited for elsewhere.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

class EventCoverage {
 public:
  /// A stream counts as complete from this long before its first event: that event is not the
  /// instant at which the sensor started to send, and an exposure often begins microseconds before
  /// its first event.
  static constexpr std::int64_t kStartSlack_ns = kNanosecondsPerMillisecond;

  /// Nothing is covered until start().
  void reset();
  bool started() const { return started_; }
  void start(std::int64_t first_event_ns);
  /// True when the stream counts as complete from later than \p t_ns only, discarded or not.
  bool beganAfter(std::int64_t t_ns) const { return started_ && began_ns_ > t_ns; }

  /// Events before \p t_ns are no longer needed; from now on, that time counts as not covered.
  void discardBefore(std::int64_t t_ns);

  /// Events are missing from \p from_ns on, until closeHole().
  void openHole(std::int64_t from_ns);
  bool holeOpen() const { return open_; }
  /// The hole ends before \p until_ns. Events at its first instant are missing at the least.
  void closeHole(std::int64_t until_ns);

  bool covers(const ExposureInterval& interval) const;

 private:
  bool started_ = false;
  std::int64_t began_ns_ = 0;
  std::int64_t from_ns_ = 0;  ///< nothing is covered before this
  std::vector<ExposureInterval> holes_;
  bool open_ = false;
  std::int64_t open_from_ns_ = 0;
};

}  // namespace fast_edi
