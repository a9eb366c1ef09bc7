/// \file
/// The noise of a frame, from the frame alone.
///
/// Blur leaves smooth areas smooth, noise does not: the response of (1, -2, 1) along a row to white
/// noise of standard deviation s has the mean absolute value sqrt(12 / pi) s. It is averaged over
/// blocks of 8 x 8 pixels; the block at the 20th percentile is one without texture. Blocks with
/// black or saturated pixels do not count: levels are cut off there.
#pragma once

#include <cstddef>
#include <vector>

#include "fast_edi/base/image.hpp"

namespace fast_edi {

class FrameNoiseEstimate {
 public:
  static constexpr float kLowest_dn = 0.3F;   ///< what rounding to whole digital numbers leaves
  static constexpr float kHighest_dn = 6.0F;  ///< what looks like more is texture

  /// \return standard deviation [8-bit DN], within [kLowest_dn, kHighest_dn]; kLowest_dn where no
  ///         block can be judged
  float of(const ImageView& frame);

  std::size_t memoryBytes() const {
    return (plane_.capacity() + response_.capacity() + lowest_.capacity() + highest_.capacity() +
            block_means_.capacity()) *
           sizeof(float);
  }

 private:
  void takeBlocks(const float* row, std::size_t width, std::size_t stride, float saturated);

  std::vector<float> plane_;
  // Of the columns of a row of blocks.
  std::vector<float> response_;
  std::vector<float> lowest_;
  std::vector<float> highest_;
  std::vector<float> block_means_;
};

}  // namespace fast_edi
