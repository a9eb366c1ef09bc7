/// \file
/// How the clocks of frames and events relate, by the times at which their messages were recorded.
///
/// A message is recorded some milliseconds after what its stamp means, so that over a recording of
/// seconds the rate at which frame stamps go on (frame seconds for each event second) is known to a
/// percent or so: enough to notice stamps that were multiplied or are in another unit, not the
/// drift of two oscillators.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace fast_edi {

/// One message: what it is stamped with and when it was recorded.
struct ClockReading {
  std::int64_t stamp_ns = 0;
  std::int64_t record_ns = 0;
};

struct ClockRelation {
  /// Events minus frames, good to some ten milliseconds. Of the frames' stamps as they are; it
  /// holds for the middle of the recording only where the rates differ.
  std::int64_t offset_ns = 0;
  /// Rate of the frames' clock by that of the events, 1 unless it certainly differs.
  double rate = 1.0;
  /// The simple number that the rate is, as near as can be told: frame stamps were multiplied by
  /// factor (or 1 / factor where `divided`). 1: none.
  int factor = 1;
  bool divided = false;
  /// The stamps themselves were multiplied: undone, they lie where the events are. Else the time
  /// since some instant was.
  bool exact = false;

  bool ratesDiffer() const { return rate != 1.0; }
  /// A frame stamp with the factor undone.
  std::int64_t undone(std::int64_t stamp_ns) const {
    return divided ? stamp_ns * factor : stamp_ns / factor;
  }
};

/// \param frames, arrays in the order of recording, each within one epoch of its clock; an array
///        is stamped with its last event
/// \return empty without a reading of each
std::optional<ClockRelation> relateClocks(const std::vector<ClockReading>& frames,
                                          const std::vector<ClockReading>& arrays);

}  // namespace fast_edi
