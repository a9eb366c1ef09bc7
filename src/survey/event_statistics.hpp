/// \file
/// Statistics that show whether events were filtered out: polarities, times between events
/// of a pixel and of neighbours, pixels that never rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Counts of times by octaves in kPerOctave bins each, from 1 us on.
class TimeHistogram {
 public:
  static constexpr int kPerOctave = 8;
  static constexpr std::size_t kBins = std::size_t{26} * kPerOctave;  ///< up to a minute

  void add(std::int64_t time_ns);
  std::uint64_t operator[](std::size_t bin) const { return counts_[bin]; }
  std::uint64_t total() const { return total_; }
  /// Where a bin begins.
  static double binStartNs(std::size_t bin);
  /// Sum of bins [first, last).
  std::uint64_t sum(std::size_t first, std::size_t last) const;

 private:
  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t total_ = 0;
};

struct HotPixel {
  int x = 0;
  int y = 0;
  double rate_hz = 0.0;
};

class EventStatistics {
 public:
  explicit EventStatistics(SensorSize size);

  void add(const Event& event);
  /// After a time jump: times to earlier events mean nothing.
  void restart(std::int64_t t_ns);

  SensorSize size() const { return size_; }
  std::uint64_t on() const { return on_; }
  std::uint64_t off() const { return off_; }
  std::uint64_t outside() const { return outside_; }  ///< not on the sensor
  /// Largest coordinates of all events, those outside among them; -1 without events.
  int largestX() const { return largest_x_; }
  int largestY() const { return largest_y_; }
  std::uint64_t inColumn(int x) const;
  std::uint64_t inRow(int y) const;
  /// From a pixel's event to its next.
  const TimeHistogram& pixelTimes() const { return pixel_times_; }
  /// Pixels whose shortest time from event to event lies in [\p from_ns, \p to_ns).
  std::size_t pixelsWithShortest(double from_ns, double to_ns) const;
  /// From the latest event of the eight neighbours to an event.
  const TimeHistogram& neighbourTimes() const { return neighbour_times_; }
  /// Pixels that fire all the time and far more than those around them, fastest first.
  std::vector<HotPixel> hotPixels() const;

 private:
  std::size_t pixelIndex(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(x);
  }
  std::size_t paddedIndex(int x, int y) const {
    return static_cast<std::size_t>(y + 1) * stride_ + static_cast<std::size_t>(x + 1);
  }

  SensorSize size_;
  std::size_t stride_;
  std::int64_t start_ns_ = 0;
  std::int64_t newest_ns_ = 0;
  std::int64_t slice_ = 0;        ///< of the newest event
  std::uint64_t slices_ = 0;      ///< that held events
  std::int64_t duration_ns_ = 0;  ///< of earlier epochs
  bool started_ = false;
  std::uint64_t on_ = 0;
  std::uint64_t off_ = 0;
  std::uint64_t outside_ = 0;
  int largest_x_ = -1;
  int largest_y_ = -1;
  std::vector<std::int64_t> last_ns_;  ///< of each pixel, with a border of one
  std::vector<std::uint32_t> counts_;
  std::vector<std::int64_t> shortest_ns_;   ///< from event to event, of each pixel
  std::vector<std::uint32_t> busy_slices_;  ///< of each pixel
  std::vector<std::int64_t> last_slice_;
  TimeHistogram pixel_times_;
  TimeHistogram neighbour_times_;
};

}  // namespace fast_edi
