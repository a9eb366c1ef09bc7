/// \file
/// Times between the events of a pixel and of its neighbours, which show whether events were
/// filtered out.
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

class InterEventTimes {
 public:
  explicit InterEventTimes(SensorSize size);

  /// \pre restart() was called; the event lies on the sensor
  void add(const Event& event);
  /// At the first event and after a time jump: times to earlier events mean nothing.
  void restart(std::int64_t t_ns);

  /// From a pixel's event to its next.
  const TimeHistogram& ofPixels() const { return of_pixels_; }
  /// From the latest event of the eight neighbours to an event.
  const TimeHistogram& ofNeighbours() const { return of_neighbours_; }
  /// Pixels whose shortest time from event to event lies in [\p from_ns, \p to_ns).
  std::size_t pixelsWithShortest(double from_ns, double to_ns) const;

 private:
  std::size_t width_;
  std::size_t stride_;  ///< of last_ns_
  std::int64_t start_ns_ = 0;
  std::vector<std::int64_t> last_ns_;      ///< of each pixel, with a border of one
  std::vector<std::int64_t> shortest_ns_;  ///< from event to event, of each pixel
  TimeHistogram of_pixels_;
  TimeHistogram of_neighbours_;
};

}  // namespace fast_edi
