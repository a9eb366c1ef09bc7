/// \file
/// How many events each pixel has, and pixels that never rest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

struct HotPixel {
  int x = 0;
  int y = 0;
  double rate_hz = 0.0;
};

/// Counts the events of each pixel, and the slices of time in which it has any.
class PixelActivity {
 public:
  explicit PixelActivity(SensorSize size);

  /// \pre restart() was called; the event lies on the sensor
  void add(const Event& event);
  /// Time is counted from \p t_ns on: at the first event and after a time jump.
  void restart(std::int64_t t_ns);

  std::uint64_t inColumn(int x) const;
  std::uint64_t inRow(int y) const;
  /// Pixels that fire all the time and far more than those around them, fastest first.
  std::vector<HotPixel> hotPixels() const;

 private:
  std::size_t pixelIndex(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(x);
  }
  /// Whether the pixel fires in nearly all slices and at a rate that matters.
  bool neverRests(std::size_t pixel, double rate_hz) const;
  /// Median count of the pixels around this one, itself among them.
  std::uint32_t medianAround(int x, int y) const;

  SensorSize size_;
  std::int64_t start_ns_ = 0;
  std::int64_t newest_ns_ = 0;
  std::int64_t duration_ns_ = 0;  ///< of earlier epochs
  std::int64_t slice_ = 0;        ///< of the newest event
  std::uint64_t slices_ = 0;      ///< that held events
  std::vector<std::uint32_t> counts_;
  std::vector<std::uint32_t> busy_slices_;  ///< of each pixel
  std::vector<std::int64_t> last_slice_;    ///< of each pixel
};

}  // namespace fast_edi
