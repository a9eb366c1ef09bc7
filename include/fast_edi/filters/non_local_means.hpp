/// \file
/// Non-local means: averages pixels whose neighbourhoods look alike, as far as noise explains what
/// they differ by (Buades, Coll and Morel, CVPR 2005).
///
/// With v the plane, s^2 its noise variance at each pixel and P(p) the 3 x 3 pixels about p, the
/// distance of two pixels in units of what noise alone gives in the mean is
///
///     r(p, q) = 1/9 sum_{d in P} (v(p + d) - v(q + d))^2 * (1 / s^2(p) + 1 / s^2(q)) / 4
///     w(p, q) = exp(-|p - q|^2 / (2 sigma^2)) * max(0, 1 - max(0, r - 1) / 4)^4
///     v'(p)   = v(p) + sum_q w(p, q) (v(q) - v(p)) / sum_q w(p, q)
///
/// so that differences within the noise count in full, and those of five times its variance not at
/// all. A corner stays where a bilateral filter rounds it: few patches look like it.
///
/// Complexity. Each pair of pixels is compared once: O(pixels * window / 2). Where all differences
/// are zero the plane stays as it is exactly.
#pragma once

#include <cstddef>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

class NonLocalMeans {
 public:
  static constexpr int kMaxWindowRadius = 4;

  struct Settings {
    int window_radius = 2;       ///< of the pixels compared with each [neighbour distances], 1..4
    float spatial_sigma = 1.5F;  ///< [neighbour distances], > 0
    int stride_px = 1;           ///< neighbour distance: 2 for one colour of a Bayer mosaic, else 1
  };

  /// \throws std::invalid_argument when a setting is out of range
  NonLocalMeans(SensorSize size, const Settings& settings);

  /// \param in width x height values
  /// \param noise_variance of each value, > 0
  /// \param out width x height values, written; may be the same memory as in
  void apply(const float* in, const float* noise_variance, float* out);

  std::size_t memoryBytes() const;

 private:
  struct Offset {
    int dx;              ///< [px]
    int dy;              ///< [px], >= 0
    float spatial_root;  ///< fourth root of the spatial weight
  };

  void pad(const float* in, std::vector<float>& padded) const;
  std::size_t indexOf(int x, int y) const;
  float* rowOf(std::vector<float>& rows, std::size_t rows_kept, std::size_t offset, int y) const;
  void addRow(std::size_t offset, int y);
  void weighRow(std::size_t offset, int y);
  void averageRow(int y, float* out);

  SensorSize size_;
  Settings settings_;
  int margin_px_;
  std::size_t padded_width_;
  std::size_t row_floats_;   ///< of what is kept by rows
  std::size_t square_rows_;  ///< kept for each offset, as many as a patch reaches over
  std::size_t weight_rows_;  ///< kept for each offset, as far as it reaches
  std::vector<Offset> offsets_;
  std::vector<float> values_;     ///< padded
  std::vector<float> precision_;  ///< padded: 1 / (36 s^2)
  std::vector<float> squares_;    ///< of differences
  std::vector<float> columns_;    ///< of a row: squares summed over the rows of patches
  std::vector<float> pair_weights_;
  std::vector<float> weighted_;  ///< of a row: sum of w (v(q) - v(p))
  std::vector<float> weight_;    ///< of a row: sum of w
};

}  // namespace fast_edi
