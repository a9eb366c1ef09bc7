/// \file
/// Takes the read and shot noise of the frame out of the latent image.
///
/// An EdgePreservingFilter on digital numbers whose range is a small multiple of the frame's noise:
/// differences that the noise explains are averaged, larger ones stay. Colours are filtered by
/// themselves: channels of interleaved images apart, a Bayer mosaic among photosites of one colour.
#pragma once

#include <vector>

#include "fast_edi/core/edge_preserving_filter.hpp"
#include "fast_edi/core/image.hpp"

namespace fast_edi {

class FrameNoiseFilter {
 public:
  struct Settings {
    float noise_dn = 1.5F;          ///< standard deviation of a frame's noise [8-bit DN], > 0
    float spatial_sigma_px = 1.5F;  ///< [neighbour distances], > 0
  };

  /// \throws std::invalid_argument when a setting is out of range
  FrameNoiseFilter(SensorSize size, PixelFormat format, const Settings& settings);

  /// \pre in and out have the size and format given at construction; they may be the same memory
  void apply(const ImageView& in, const MutableImageView& out);

  std::size_t memoryBytes() const {
    return filter_.memoryBytes() + plane_.capacity() * sizeof(float);
  }

 private:
  SensorSize size_;
  PixelFormat format_;
  EdgePreservingFilter filter_;
  std::vector<float> plane_;
};

}  // namespace fast_edi
