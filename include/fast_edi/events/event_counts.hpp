/// \file
/// How many events of each polarity every pixel had in an exposure, counted while they come.
///
/// The counts of a range of the log are whole numbers: events are added at its end and taken away
/// at its beginning in any order, and the result depends on the window alone. So events are counted
/// ahead for the coming window, and count() corrects the ends.
///
/// Complexity. One increment of two bytes for each event; count() costs O(events between the range
/// counted so far and the window), and O(pixels) when none of it is of use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

class EventCounts {
 public:
  explicit EventCounts(SensorSize size) : counts_(2 * size.pixelCount()) {}

  /// Discards all counts. Must be called when the lists were flushed or reset.
  void reset();
  /// Counts what the lists hold of the coming window, in event time.
  void accumulate(const PixelEventLists& lists, const ExposureInterval& window);
  /// Counts the events in [window.start, window.end).
  void count(const PixelEventLists& lists, const ExposureInterval& window);

  /// Events of a pixel (row-major index) in the window of the last count(), modulo 65536.
  std::uint16_t off(std::size_t pixel) const { return counts_[2 * pixel]; }
  std::uint16_t on(std::size_t pixel) const { return counts_[2 * pixel + 1]; }
  /// OFF and ON counts of all pixels, interleaved: 2 * pixelCount() values.
  const std::uint16_t* data() const { return counts_.data(); }
  std::size_t pixelCount() const { return counts_.size() / 2; }

  std::size_t memoryBytes() const { return counts_.capacity() * sizeof(std::uint16_t); }

 private:
  void moveTo(const PixelEventLists& lists, std::uint64_t begin, std::uint64_t end);

  std::vector<std::uint16_t> counts_;
  std::uint64_t begin_ = 0;  ///< sequence numbers [begin_, end_) of the log are counted
  std::uint64_t end_ = 0;
};

}  // namespace fast_edi
