/// \file
/// Dense optical flow after Lucas & Kanade (IJCAI 1981), coarse to fine.
///
/// Finds the displacement u(x) with from(x) = to(x + u(x)): on each level of an image pyramid,
/// twice, the minimum of
///
///     sum_y w(y - x) (to(y + u) - from(y))^2 + lambda |u - u_before|^2
///
/// linearised about the displacements u_before of the coarser level. The window w is a box filter
/// applied twice, so that pixels with texture speak for their neighbours without; where there is
/// none at all, u_before stays. Gradients are those of the mean of both images. The finest level
/// has half the image's resolution: the full one costs four times as much and was no better.
/// It is the mean of 2 x 2 pixels, so that a Bayer mosaic does not show.
///
/// Made for displacements of up to a tenth of the image and for fields that vary little within
/// 20 pixels: the camera's own motion. Who uses it must look whether it fits (MotionCompensation).
///
/// Complexity. O(pixels).
#pragma once

#include <cstddef>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// [px], right and down.
struct Displacement {
  float x = 0.0F;
  float y = 0.0F;
};

class OpticalFlow {
 public:
  explicit OpticalFlow(SensorSize size);

  /// The image that displacements lead to.
  /// \param plane width x height levels [8-bit DN], finite; copied
  void setTarget(const float* plane);

  /// \param plane width x height levels [8-bit DN], finite
  /// \return width x height displacements, valid until the next call
  /// \pre setTarget() was called
  const std::vector<Displacement>& from(const float* plane);

  std::size_t memoryBytes() const;

 private:
  /// An image or a field, row-major.
  template <typename Element>
  struct Grid {
    SensorSize size;
    std::vector<Element> at;
  };
  void buildPyramid(const float* plane, std::vector<Grid<float>>& levels) const;
  void refine(std::size_t level);
  void warpTarget(const Grid<float>& target);
  void collectTerms(const Grid<float>& from);
  void sumOverWindows(SensorSize size);
  void solve();
  void upsample(SensorSize size);

  SensorSize size_;
  std::vector<Grid<float>> target_;  ///< finest level first
  std::vector<Grid<float>> from_;
  Grid<Displacement> flow_;
  std::vector<Displacement> coarse_flow_;
  std::vector<Displacement> coarse_row_;
  std::vector<float> warped_;
  // What pixels add to the normal equations; eight floats each, so that sums are vectorised.
  std::vector<float> terms_;
  std::vector<float> row_sums_;
  std::vector<float> column_sums_;
};

}  // namespace fast_edi
