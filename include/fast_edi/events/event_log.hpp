/// \file
/// The log: events in time order, numbered, of bounded number.
///
/// Layout. 8-byte records {time since the chunk's base [ns], pixel index and polarity}, in chunks
/// of kChunkEvents. Appending is a sequential store; dropping what no later frame needs returns
/// whole chunks to a free list.
///
/// Invariants
/// - Times never decrease along the log, and pixels lie on the sensor; who appends sees to both.
/// - eventCount() <= max_events; when full, the oldest chunk goes and coverage moves up with it.
/// - Sequence numbers count events since construction and never repeat.
///
/// Complexity. Appending O(1) per event, discardBefore() O(chunks dropped), lowerBound() and span()
/// by bisection. Memory: 8 B per buffered event (plus chunks that are not full or not in use),
/// nothing per pixel; no allocation once the working set of chunks has been reached. Chunks that a
/// burst took are given back within some dozens of discardBefore(), or by flush(); a few stay as a
/// spare. With keepIntervals() 2 B more for each event and 4 B for each pixel, and about
/// a nanosecond more for each event.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "fast_edi/events/event_intervals.hpp"
#include "fast_edi/events/packed_event.hpp"

namespace fast_edi {

class EventLog {
 public:
  static constexpr std::size_t kChunkEvents = 1u << 16;
  /// Times within a chunk fit 31 bits.
  static constexpr std::int64_t kMaxDt_ns = std::numeric_limits<std::int32_t>::max();

  /// Memory behind the newest event, where the next ones are written.
  struct Tail {
    PackedEvent* events;
    std::size_t room;      ///< for so many events
    std::int64_t base_ns;  ///< PackedEvent::dt_ns is their time since then
  };

  /// Empties the log and sets its bounds; keeps no intervals then. The first call comes before all
  /// others.
  /// \param pixels of the sensor
  /// \pre max_events >= 1
  void reset(std::size_t pixels, std::size_t max_events);
  /// Drops everything; the next event may have any time.
  void flush();
  /// Drops whole chunks that lie before \p t_ns entirely.
  void discardBefore(std::int64_t t_ns);

  /// Makes this log one of the events of another from \p from_ns to \p to_ns, and some around them,
  /// to read on another thread while that one goes on. Nothing may be appended. Full chunks are
  /// shared rather than copied; the other log does not write to them again.
  void share(const EventLog& other, std::int64_t from_ns, std::int64_t to_ns);

  /// Whether to keep each event's interval since the one before it in its pixel. Switched on, the
  /// events that are buffered get theirs, too; what came before these is not known.
  void keepIntervals(bool keep);
  bool keepsIntervals() const { return keeps_intervals_; }

  /// Whether so many events more are within max_events.
  bool fits(std::size_t events) const { return eventCount() + events <= max_events_; }
  /// The newest chunk's free memory. \pre !empty()
  Tail tail() {
    Chunk& newest = *chunks_.back();
    return {newest.events + newest.count, kChunkEvents - newest.count, newest.base_ns};
  }
  /// Free memory for at least one event of time \p t_ns: of the newest chunk, or of a new one where
  /// that is full or too old. When the log is full, its oldest chunk is dropped.
  Tail tailFor(std::int64_t t_ns) {
    if (!fits(1) || !newestTakes(t_ns)) {
      makeRoom(t_ns);
    }
    return tail();
  }
  /// Takes in the events that were written to the tail.
  /// \pre 1 <= count <= room of the tail
  void extend(std::size_t count) {
    Chunk& newest = *chunks_.back();
    if (keeps_intervals_) {
      measureIntervals(newest, newest.count, count);
    }
    newest.count += count;
    end_sequence_ += count;
  }

  std::size_t eventCount() const {
    return static_cast<std::size_t>(end_sequence_ - begin_sequence_);
  }
  bool empty() const { return end_sequence_ == begin_sequence_; }
  /// Every event from this time on that was ever taken in is still here. After an overflow or
  /// discardBefore() this moves up; INT64_MIN while nothing was dropped.
  std::int64_t completeFrom() const { return complete_from_ns_; }
  /// Events dropped because max_events was reached, since construction.
  std::uint64_t overflowed() const { return overflowed_; }
  /// Bytes allocated for events and intervals, free chunks included.
  std::size_t memoryBytes() const;

  /// Sequence numbers [beginSequence, endSequence) are buffered.
  std::uint64_t beginSequence() const { return begin_sequence_; }
  std::uint64_t endSequence() const { return end_sequence_; }
  /// Sequence number of the first buffered event with time >= t_ns (endSequence() if none).
  std::uint64_t lowerBound(std::int64_t t_ns) const;
  /// The longest contiguous span that starts at \p sequence and ends before \p end_sequence.
  PackedEventSpan span(std::uint64_t sequence, std::uint64_t end_sequence) const;

 private:
  // Events are written before they are read.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  struct Chunk {
    std::int64_t base_ns = 0;
    std::uint64_t first_sequence = 0;
    std::size_t count = 0;
    bool is_shared = false;                ///< other logs may read it for as long as it lives
    std::vector<std::uint16_t> intervals;  ///< of the events, once they were kept
    PackedEvent events[kChunkEvents];

    std::int64_t time(std::size_t i) const { return base_ns + events[i].dt_ns; }
    std::int64_t newest() const { return time(count - 1); }
    std::uint64_t endSequence() const { return first_sequence + count; }
  };

  bool newestTakes(std::int64_t t_ns) const {
    return !chunks_.empty() && chunks_.back()->count < kChunkEvents &&
           t_ns - chunks_.back()->base_ns <= kMaxDt_ns;
  }
  static std::shared_ptr<Chunk> copyOf(const Chunk& chunk);
  void makeRoom(std::int64_t t_ns);
  void beginChunk(std::int64_t t_ns);
  void overflow();
  void dropFront();
  void recycle(std::shared_ptr<Chunk> chunk);
  void unshare();
  void trim();
  void measureIntervals(Chunk& chunk, std::size_t first, std::size_t count);
  std::size_t chunkIndex(std::uint64_t sequence) const;

  std::size_t pixels_ = 0;
  std::size_t max_events_ = 0;
  std::size_t max_chunks_ = 0;
  std::vector<std::shared_ptr<Chunk>> chunks_;  ///< oldest first, never empty ones
  std::vector<std::shared_ptr<Chunk>> free_chunks_;
  std::size_t working_set_ = 0;  ///< chunks that were in use at once lately
  std::uint64_t begin_sequence_ = 0;
  std::uint64_t end_sequence_ = 0;
  std::int64_t complete_from_ns_ = INT64_MIN;
  std::uint64_t overflowed_ = 0;
  bool keeps_intervals_ = false;
  EventIntervals intervals_;
};

}  // namespace fast_edi
