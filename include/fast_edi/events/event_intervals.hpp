/// \file
/// For each event the time since the event before it in the same pixel, as LevelModel needs it.
///
/// In ticks of kIntervalTick_ns. An interval is the difference of both events' ticks less one, so
/// never longer than the true one, and kMostIntervalTicks where it is longer or there was no event
/// before. The result depends on the sequence of events alone, not on how it is cut into calls.
///
/// Complexity. O(1) for each event, by random access to 4 B per pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/events/packed_event.hpp"

namespace fast_edi {

class EventIntervals {
 public:
  /// Starts with pixels that have had no event.
  void reset(std::size_t pixels);
  /// Gives the memory back.
  void release() { std::vector<std::uint32_t>().swap(last_ticks_); }

  /// \param events in the order of time, not older than those of the calls before
  /// \param base_ns add PackedEvent::dt_ns for an event's time
  /// \param ticks \p count values, written
  void measure(const PackedEvent* events, std::size_t count, std::int64_t base_ns,
               std::uint16_t* ticks);

  std::size_t memoryBytes() const { return last_ticks_.capacity() * sizeof(std::uint32_t); }

 private:
  void forgetOld(std::int64_t tick);

  std::vector<std::uint32_t> last_ticks_;  ///< of each pixel's last event, modulo 2^32
  std::int64_t newest_tick_ = 0;
  std::int64_t checked_tick_ = 0;  ///< forgetOld() last went through all pixels
  bool has_newest_ = false;
};

}  // namespace fast_edi
