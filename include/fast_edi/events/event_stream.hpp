/// \file
/// Feeds event arrays into the lists. Checks sensor size, lost arrays and jumps of the event clock,
/// and keeps track of the times for which events are complete.
///
/// Time jumps. Back: the events go back by more than max_backward_jump and stay there to the end of
/// their array. Ahead: more than max_forward_jump, and the next array that holds events lies there
/// too. A single event back at the end of its array waits for the next array just the same. Until a
/// jump is confirmed its events are held apart; refuted, they are dropped and counted. Confirmed,
/// the lists are emptied and a new epoch begins with them.
///
/// An array jumps back once by itself; a second jump that lasts to its end is held apart like one
/// ahead. Events that were held apart jump twice; what lies behind a third jump is dropped.
///
/// Repetitions. An array that came before, and whose jump back would be none, is dropped. Others of
/// its events would be late; those at the time of the newest event would count twice. A publisher
/// with numbers of its own sends such arrays, so that numbers say nothing then.
///
/// Complexity: linear in the events, whatever their times; see recordsRead(). One
/// PixelEventLists::append() for each array unless something is wrong with its times.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_coverage.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/events/recent_arrays.hpp"
#include "fast_edi/events/sequence_gaps.hpp"
#include "fast_edi/events/time_jump.hpp"

namespace fast_edi {

/// Why the lists are emptied.
enum class StreamReset {
  kTimeJump,    ///< the event clock jumped
  kSizeChange,  ///< the sensor's size changed; the clock goes on
};

class EventStream {
 public:
  /// Called just before the lists are emptied: the last chance to use what they hold.
  /// \param next_event_ns the first event of the new epoch
  using ResetHandler = std::function<void(StreamReset kind, std::int64_t next_event_ns)>;

  static constexpr std::uint64_t kMostReadings = 10;

  /// \param counters all events_... and event_... are counted there; must outlive this object
  EventStream(PixelEventLists::Limits limits, DeblurCounters& counters, ResetHandler before_reset);

  /// One event array; see Deblurrer::addEvents(). \param sequence nothing: arrays have no numbers
  void take(const WireEvents& events, SensorSize size, std::optional<std::uint32_t> sequence);
  /// See Deblurrer::noteLostEvents().
  void noteLost(std::size_t events);
  /// See Deblurrer::noteMissingArrays().
  void noteMissing();
  /// Drops events whose time jump is not confirmed: no array will come any more.
  void dropHeld();
  /// Empties everything; the next array starts a new stream.
  void restart();
  /// See PixelEventLists::keepIntervals(). \pre seen()
  void keepIntervals(bool keep) { lists_->keepIntervals(keep); }
  /// Changes of limits empty the lists.
  void setLimits(PixelEventLists::Limits limits);
  /// Events before \p t_ns are no longer needed.
  void discardBefore(std::int64_t t_ns);

  /// True from noteMissing() until the next array: waiting for events is useless.
  bool stopped() const { return stopped_; }
  /// True once a valid array came, be it empty.
  bool seen() const { return seen_; }
  /// Null until the first valid array. \pre use only while seen()
  const PixelEventLists* lists() const { return lists_.get(); }
  /// True when all events before \p t_ns have come: the newest event is as late, or one is known to
  /// come next that is.
  bool hasReached(std::int64_t t_ns) const;
  /// True when the newest event is later than \p t_ns.
  bool isPast(std::int64_t t_ns) const;
  /// True when the epoch's first event is later than \p t_ns, whatever was discarded since.
  bool beganAfter(std::int64_t t_ns) const { return coverage_.beganAfter(t_ns); }
  /// True when no event of the interval is missing, apart from those still to come.
  bool covers(const ExposureInterval& interval) const;
  /// Changes whenever the lists were emptied.
  std::uint64_t generation() const { return generation_; }
  /// Records read since construction, each as often as it was: what the work is proportional to. At
  /// most kMostReadings times the events that came.
  std::uint64_t recordsRead() const { return records_read_; }
  /// Bytes of the lists and of events held apart.
  std::size_t memoryBytes() const;

 private:
  bool isRepeated(const WireEvents& events, SensorSize size) const;
  void markMissingArrays();
  void setSize(SensorSize size, const WireEvents& next);
  void resolveHeldJump(std::int64_t next_array_ns);
  void ingest(WireEvents events, bool may_jump);
  void beginEpoch(std::int64_t first_event_ns);
  void noteAccepted(std::uint64_t sequence);
  void flush();

  PixelEventLists::Limits limits_;
  DeblurCounters& counters_;
  ResetHandler before_reset_;
  std::unique_ptr<PixelEventLists> lists_;
  bool seen_ = false;
  SequenceGaps sequence_gaps_;
  RecentArrays recent_arrays_;  ///< of this epoch
  bool stopped_ = false;
  bool arrays_missing_ = false;  ///< between the last array taken in and the next
  EventCoverage coverage_;
  std::uint64_t generation_ = 0;
  std::uint64_t records_read_ = 0;
  std::int64_t next_event_ns_ = INT64_MIN;  ///< known to come next, while the lists are reset

  std::vector<std::uint8_t> held_;  ///< wire records that wait for their jump to be confirmed
  TimeJump held_jump_;
};

}  // namespace fast_edi
