/// \file
/// Steadies a latent image by another one of the same exposure, along the motion between them.
///
/// What events say of the change from the middle of an exposure to another instant t grows less
/// certain with every event and with all that stays below the contrast threshold; the image of the
/// middle is the best there is, since there the errors before and behind weigh least. So
///
///     L'(x, t) = L(x, t) + w(x) (L(x + u, middle) - L(x, t))
///
/// with u the OpticalFlow from t to the middle. w falls from 0.9 to 0 where the difference,
/// averaged over 5 x 5 px so that noise does not count, passes a tenth of the level: what moves by
/// itself, what is covered or comes into sight, and light that changes stays as events say. Levels
/// between pixels are interpolated by cubic splines (Catmull-Rom). Pixels of a Bayer mosaic are
/// interpolated from those of their colour.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/latent/optical_flow.hpp"

namespace fast_edi {

class MotionCompensation {
 public:
  MotionCompensation();

  /// \param middle latent image at mid-exposure, of any size and format; copied. Memory stays while
  /// these do.
  void setReference(const ImageView& middle);

  /// \param image latent image at another instant, of the reference's size and format; changed in
  /// place
  /// \pre setReference() was called
  void apply(const MutableImageView& image);

  std::size_t memoryBytes() const;

 private:
  /// Of the pixels at -1, 0, 1 and 2.
  using CubicWeights = std::array<float, 4>;

  struct Lattice;
  struct Taps;

  void fit(SensorSize size, PixelFormat format);
  void loadPlanes(const ImageView& image, std::vector<std::vector<float>>& planes);
  void warp(const std::vector<float>& reference, const std::vector<Displacement>& flow,
            const std::vector<float>& own);
  float sample(const float* plane, const Lattice& horizontal, float x, const Lattice& vertical,
               float y) const;
  void averageDifferences();

  SensorSize size_;
  PixelFormat format_ = PixelFormat::kMono8;
  int stride_px_ = 1;                          ///< distance of pixels of one colour
  float dn_ = 1.0F;                            ///< levels of the format in an 8-bit DN
  std::optional<OpticalFlow> flow_;            ///< none before the first reference
  std::vector<std::vector<float>> reference_;  ///< a plane for each channel
  std::vector<std::vector<float>> own_;        ///< a plane for each channel
  std::vector<float> grey_;                    ///< mean of the channels [8-bit DN]
  std::vector<float> difference_;              ///< warped reference minus own level
  std::vector<float> mean_difference_;
  std::vector<float> row_sums_;
  std::vector<CubicWeights> cubic_;  ///< by the fraction of the way from 0 to 1
};

}  // namespace fast_edi
