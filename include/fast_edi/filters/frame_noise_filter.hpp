/// \file
/// Takes the read and shot noise of the frame, and what the gains made of it, out of the latent
/// image.
///
/// NonLocalMeans on digital numbers J over 3 x 3 pixels. With s_B the noise of the blurry frame and
/// n' the mean count of events about a pixel, the variance taken for noise is
///
///     s^2 = (1.5 s_B)^2 + (0.02 J)^2 min(1, n') (1 + n' / 3)
///
/// A fraction of what it takes out stays: texture as faint as the noise goes with the noise, and
/// feature trackers, whose thresholds are relative, lose its corners.
///
/// Where there are no events, only the frame's own noise is taken out. Saturated levels are lower
/// bounds rather than measurements and stay. Colours are filtered by themselves: channels of
/// interleaved images apart, a Bayer mosaic among photosites of one colour.
#pragma once

#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/filters/non_local_means.hpp"

namespace fast_edi {

class FrameNoiseFilter {
 public:
  /// \param kept fraction of the noise that stays, 0 to 1
  FrameNoiseFilter(SensorSize size, PixelFormat format, double kept);

  /// \param noise_dn standard deviation of the blurry frame's noise [8-bit DN], > 0
  /// \param mean_count of events about each pixel, width x height values
  /// \pre in and out have the size and format given at construction; they may be the same memory
  void apply(const ImageView& in, float noise_dn, const float* mean_count,
             const MutableImageView& out);

  /// Levels without any of the noise, of the last apply()'s last channel, row-major [DN].
  const std::vector<float>& clean() const { return clean_; }

  std::size_t memoryBytes() const {
    return filter_.memoryBytes() +
           (plane_.capacity() + variance_.capacity() + clean_.capacity()) * sizeof(float);
  }

 private:
  SensorSize size_;
  PixelFormat format_;
  float kept_;
  NonLocalMeans filter_;
  std::vector<float> plane_;
  std::vector<float> variance_;
  std::vector<float> clean_;  ///< of the last channel
};

}  // namespace fast_edi
