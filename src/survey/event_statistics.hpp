/// \file
/// Statistics that show whether events were filtered out: polarities, times between events
/// of a pixel and of neighbours, pixels that never rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "survey/inter_event_times.hpp"
#include "survey/pixel_activity.hpp"

namespace fast_edi {

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
  std::uint64_t inColumn(int x) const { return activity_.inColumn(x); }
  std::uint64_t inRow(int y) const { return activity_.inRow(y); }
  /// From a pixel's event to its next.
  const TimeHistogram& pixelTimes() const { return times_.ofPixels(); }
  /// Pixels whose shortest time from event to event lies in [\p from_ns, \p to_ns).
  std::size_t pixelsWithShortest(double from_ns, double to_ns) const {
    return times_.pixelsWithShortest(from_ns, to_ns);
  }
  /// From the latest event of the eight neighbours to an event.
  const TimeHistogram& neighbourTimes() const { return times_.ofNeighbours(); }
  /// Pixels that fire all the time and far more than those around them, fastest first.
  std::vector<HotPixel> hotPixels() const { return activity_.hotPixels(); }

 private:
  SensorSize size_;
  bool started_ = false;
  std::uint64_t on_ = 0;
  std::uint64_t off_ = 0;
  std::uint64_t outside_ = 0;
  int largest_x_ = -1;
  int largest_y_ = -1;
  PixelActivity activity_;
  InterEventTimes times_;
};

}  // namespace fast_edi
