/// \file
/// Stabilises a latent image with that of mid-exposure, warped along the optical flow between them.
///
/// The change between mid-exposure and another instant t, integrated from events, becomes less
/// certain with every event and with every change below the contrast threshold. Mid-exposure has
/// the smallest error, since errors of both halves partly cancel there. So
///
///     L'(x, t) = L(x, t) + w(x) (L(x + u, middle) - L(x, t))
///
/// with u the OpticalFlow from t to the middle. w falls from 0.9 to 0 where the difference,
/// averaged over 5 x 5 px against noise, exceeds a tenth of the level: independent motion,
/// occlusions and changes of illumination remain as events give them. Levels
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
