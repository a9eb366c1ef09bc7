/// \file
/// Finds pixels whose events cannot come from the scene, alone or in small groups and columns, and
/// gives them the values of their neighbours.
///
/// A hot pixel fires by itself, at tens to thousands of events per second, nearly all of one
/// polarity. Taken at their word these events change its intensity by many times what the frame
/// shows anywhere near it. A pixel is hot when all of this holds:
///
/// - it has at least 6 events, at most a quarter of them of the other polarity;
/// - its events add up to |c_on n_on - c_off n_off|, a change of log intensity that exceeds the
/// range
///   of the frame's log intensity over the 7 x 7 pixels about it by more than 1.5;
/// - few pixels of these 7 x 7 change by a third of that, or have as many events as it: seven, as
///   many as a column of hot pixels has there. The edge of something that moves has more; lamps
///   that flicker give events everywhere, but these add up to little.
///
/// Events of a true edge, however strong, change the intensity between levels that the frame shows
/// beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/filters/exposure_events.hpp"

namespace fast_edi {

class HotPixelFilter {
 public:
  explicit HotPixelFilter(SensorSize size);

  /// Looks for hot pixels.
  /// \param level_dn width x height levels of the blurry frame [8-bit DN]
  /// \param count events of each pixel in the exposure
  /// \return how many there are
  std::size_t find(const float* level_dn, const float* count, const ExposureEvents& events);

  /// Replaces the values of the pixels found by the mean of the nearest others (0 where there is
  /// none within 7 x 7 pixels).
  void fill(float* plane);

  std::size_t memoryBytes() const {
    return hot_.capacity() * sizeof(std::size_t) + is_hot_.capacity() +
           (change_.capacity() + filled_.capacity()) * sizeof(float) +
           is_suspect_.capacity() * sizeof(std::int32_t);
  }

 private:
  bool isHot(int x, int y, const float* level_dn, const float* count) const;
  float meanAround(std::size_t pixel, const float* plane) const;

  SensorSize size_;
  std::vector<float> change_;  ///< what the events of each pixel add up to [natural log]
  std::vector<std::int32_t> is_suspect_;
  std::vector<std::size_t> hot_;      ///< row-major indices
  std::vector<std::uint8_t> is_hot_;  ///< of each pixel
  std::vector<float> filled_;         ///< their new values
};

}  // namespace fast_edi
