/// \file
/// The container: each pixel's events in time order, filled event by event.
///
/// Model. For every pixel a list of its events, oldest first; Lin et al. (ICRA 2023) write a list
/// as pairs <exp value, counter>, see list(). Any exposure window and any reference time can be
/// asked for afterwards, since nothing about exposures is known when events come.
///
/// Layout. The lists of all pixels are interleaved in one time-ordered EventLog.
///
/// Invariants beside those of EventLog
/// - Times never decrease along the log (late events are refused and counted).
/// - Every record's pixel lies on the sensor.
///
/// Complexity. append O(1) per event, list() O(events in window). Memory: that of EventLog.
/// Wins where all pixels are integrated over the same window (every frame). Loses against lists
/// that lie apart when only few pixels of a long window are asked for: list() scans the window.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_log.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/events/packed_event.hpp"

namespace fast_edi {

/// One entry of a pixel's list as the paper writes it.
struct ListEntry {
  double exp_value = 1.0;    ///< latent value from this event on, relative to the window's start
  std::int64_t counter = 0;  ///< events anywhere in the frame before this one, within the window
  std::int64_t t_ns = 0;     ///< sensor time of the event
};

/// Why append() stopped.
enum class AppendStop {
  kNone,          ///< took in everything
  kBackwardJump,  ///< the next event is older than the newest by more than max_backward_jump_ns
  kForwardJump,   ///< the next event is newer than the newest by more than max_forward_jump_ns
};

struct AppendResult {
  std::size_t consumed = 0;  ///< records looked at: accepted + late + outside
  std::size_t accepted = 0;
  std::size_t late = 0;     ///< older than the newest event, within the jump limit: dropped
  std::size_t outside = 0;  ///< not on the sensor: dropped
  std::size_t read = 0;     ///< records read, some of them twice
  AppendStop stop = AppendStop::kNone;
};

class PixelEventLists {
 public:
  static constexpr std::size_t kChunkEvents = EventLog::kChunkEvents;

  struct Limits {
    std::size_t max_events = 13'000'000;
    std::int64_t max_backward_jump_ns = 500 * kNanosecondsPerMillisecond;
    std::int64_t max_forward_jump_ns = 10'000 * kNanosecondsPerMillisecond;
  };

  /// \throws std::invalid_argument unless 1 <= width, height <= 32767, max_events >= 1, limits > 0
  PixelEventLists(SensorSize size, Limits limits);
  /// The events of \p window in other lists, and some around them, to read on another thread while
  /// those go on: see EventLog::share(). Nothing may be appended.
  PixelEventLists(const PixelEventLists& other, const ExposureInterval& window);
  ~PixelEventLists();
  PixelEventLists(const PixelEventLists&) = delete;
  PixelEventLists& operator=(const PixelEventLists&) = delete;

  /// Takes in wire records in order. Stops *before* an event that jumps in time; the caller decides
  /// whether to flush() and go on from there, or to skip it.
  AppendResult append(const WireEvents& events);
  AppendResult append(const Event& event);

  /// Drops whole chunks that lie before \p t_ns entirely.
  void discardBefore(std::int64_t t_ns) { log_.discardBefore(t_ns); }
  /// Drops everything; the next event may have any time.
  void flush();
  /// Empties the container and changes the sensor's size or the limits. Keeps no intervals then, so
  /// that a size alone costs no memory.
  void reset(SensorSize size, Limits limits);

  /// Whether to keep each event's interval since the one before it in its pixel. Switched on, the
  /// events that are buffered get theirs, too; what came before these is not known.
  void keepIntervals(bool keep) { log_.keepIntervals(keep); }
  bool keepsIntervals() const { return log_.keepsIntervals(); }

  SensorSize size() const { return size_; }
  std::size_t eventCount() const { return log_.eventCount(); }
  bool empty() const { return log_.empty(); }
  /// Sensor time of the newest event; meaningless while !hasNewest().
  std::int64_t newest() const { return newest_ns_; }
  /// True once an event was taken in since construction, flush() or reset().
  bool hasNewest() const { return has_newest_; }
  /// Every event from this time on that was ever taken in is still here. After an overflow or
  /// discardBefore() this moves up; INT64_MIN while nothing was dropped.
  std::int64_t completeFrom() const { return log_.completeFrom(); }
  /// Events dropped because max_events was reached, since construction.
  std::uint64_t overflowed() const { return log_.overflowed(); }
  /// Bytes allocated for events and intervals, free chunks included.
  std::size_t memoryBytes() const { return log_.memoryBytes(); }

  /// Sequence numbers [beginSequence, endSequence) are buffered.
  std::uint64_t beginSequence() const { return log_.beginSequence(); }
  std::uint64_t endSequence() const { return log_.endSequence(); }
  /// Sequence number of the first buffered event with time >= t_ns (endSequence() if none).
  std::uint64_t lowerBound(std::int64_t t_ns) const { return log_.lowerBound(t_ns); }
  /// The longest contiguous span that starts at \p sequence and ends before \p end_sequence.
  PackedEventSpan span(std::uint64_t sequence, std::uint64_t end_sequence) const {
    return log_.span(sequence, end_sequence);
  }

  /// One pixel's list over [window.start, window.end) as <exp value, counter> pairs.
  std::vector<ListEntry> list(int x, int y, const ExposureInterval& window,
                              const ContrastThresholds& thresholds) const;

 private:
  std::size_t appendRegular(const WireEvents& events, AppendResult& result);
  AppendStop appendOne(const Event& event, AppendResult& result);

  SensorSize size_;
  Limits limits_;
  std::size_t block_events_ = 0;  ///< records of the next block that is taken to be regular
  std::size_t one_by_one_ = 0;    ///< records to take one by one before that
  std::size_t distrust_ = 0;      ///< records; grows with each block that was not regular
  std::int64_t newest_ns_ = 0;
  bool has_newest_ = false;
  EventLog log_;
};

}  // namespace fast_edi
