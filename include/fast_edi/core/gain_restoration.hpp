/// \file
/// Gives back to the map of log gains what it has lost: smoothing lowers its fine structure, and
/// the sensor's photoreceptor, a low-pass, lowers that of quick changes before any event is made.
///
/// With g the log gain of a pixel and m the mean of its neighbourhood (17 x 17 px), d = g - m is
/// structure. As much of it as has the sign of g, and no more than g, is raised:
///
///     c = d limited to the range between 0 and g, then to +-0.35,
///     g' = g + strength * c^3 / (c^2 + s^2)
///
/// s = 0.055, a quarter of a usual contrast threshold, keeps what may be noise as it is; what
/// stands out by more than 0.35 is an edge, which smoothing does not lower. A pixel without gain
/// stays without, and a gain that is the same all over (flicker, a light switched on) stays.
#pragma once

#include <cstdint>
#include <vector>

#include "fast_edi/core/types.hpp"

namespace fast_edi {

class GainRestoration {
 public:
  static constexpr int kRadius = 8;  ///< of the neighbourhood [px]
  static constexpr float kMaxStrength = 1.0F;

  /// \param strength fraction that is given back [0, kMaxStrength]
  /// \throws std::invalid_argument when strength is out of range
  GainRestoration(SensorSize size, float strength);

  /// Restores width x height log gains in place.
  /// \pre each lies within +-log DoubleIntegral::kMaxGain
  void apply(float* log_gain);

  std::size_t memoryBytes() const {
    return column_sums_.capacity() * sizeof(std::int32_t) +
           (means_.capacity() + original_.capacity()) * sizeof(float);
  }

 private:
  void addRow(const float* row);
  void removeRow(const float* row);
  void meansOfRow(int y);

  SensorSize size_;
  float strength_;
  // Sums are kept as integers: they stay exact while rows and columns come and go.
  std::vector<std::int32_t> column_sums_;
  std::vector<float> means_;
  std::vector<float> original_;
};

}  // namespace fast_edi
