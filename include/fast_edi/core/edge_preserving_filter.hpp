/// \file
/// A small bilateral filter (Tomasi & Manduchi, ICCV 1998) for planes of floats.
///
///     out(p) = sum_q w(q - p) r(in(q) - in(p)) in(q) / sum_q w(q - p) r(in(q) - in(p))
///
/// over the 5 x 5 neighbours q of p, w a Gaussian of the distance and r of the difference. The
/// latter is max(0, 1 - d^2 / (8 sigma^2))^4, which is within 0.06 of exp(-d^2 / (2 sigma^2)),
/// reaches zero, and needs no exp. Beyond the border, the nearest pixel inside counts.
#pragma once

#include <cstddef>
#include <vector>

#include "fast_edi/core/types.hpp"

namespace fast_edi {

class EdgePreservingFilter {
 public:
  static constexpr int kRadius = 2;
  /// Below it a float does not hold what the weights are computed from; and so narrow a filter
  /// changes nothing.
  static constexpr float kMinSigma = 1e-3F;

  struct Settings {
    float range_sigma = 1.0F;    ///< differences well above it are edges [unit of the plane]
    float spatial_sigma = 1.0F;  ///< [neighbour distances]
    int stride_px = 1;           ///< distance of neighbours: 2 for the colours of a Bayer mosaic
  };

  /// \throws std::invalid_argument unless both sigmas are finite and at least kMinSigma and the
  ///         stride is 1 or 2
  EdgePreservingFilter(SensorSize size, const Settings& settings);

  /// \p in and \p out: width x height floats, row-major; they may be the same.
  /// \pre no NaN or infinity in \p in
  void apply(const float* in, float* out);

  std::size_t memoryBytes() const;

 private:
  void pad(const float* in);

  SensorSize size_;
  Settings settings_;
  int margin_px_;
  std::size_t padded_width_;
  std::vector<float> padded_;
  std::vector<float> weighted_;  ///< one row of sum w r (in(q) - in(p))
  std::vector<float> weight_;    ///< one row of sum w r
};

}  // namespace fast_edi
