/// \file
/// Fits the motion of the image during an exposure to the events in it.
///
/// Where the latent image L of mid-exposure has moved by u at another instant (ImageMotion), the
/// log intensity of a pixel has changed by what its events say, S (EventChanges):
///
///     log L(x + u(x, tau)) - log L(x) = S(x, tau)
///
/// Gauss-Newton over some 1,200 pixels with events at four instants, coarse to fine on images of a
/// quarter, half and full resolution. Residuals r count with weight 1 / (1 + (r / spread)^2)^2.
/// Levels between two thresholds have moved further than their events say; S is raised by up to a
/// quarter where a pixel has few events, as GainFilter does it with gains. Without this all motions
/// come out a tenth too small.
///
/// Deviation. From the normal equations at the end; neighbouring pixels are not independent, and
/// their number counts as a quarter.
///
/// Complexity. O(pixels) for the three levels, then O(1,200 * instants * steps).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "reblur/event_changes.hpp"
#include "reblur/image_motion.hpp"

namespace fast_edi {

/// What was found.
struct FittedMotion {
  ImageMotion motion;
  float deviation_px = 0.0F;  ///< standard deviation of a displacement, largest in the image
  float path_px = 0.0F;       ///< way from start to middle and on to the end, mean over the image
  float reach_px = 0.0F;      ///< largest displacement
  bool found = false;         ///< false: too few pixels had events, the rest is 0
};

class MotionFit {
 public:
  explicit MotionFit(SensorSize size);

  /// \param log_image log intensity at mid-exposure of width x height pixels
  /// \param changes of the same pixels
  /// \param mean_counts events of each pixel in the exposure, mean over 3 x 3 pixels
  /// \param contrast mean contrast threshold
  FittedMotion fit(const float* log_image, const EventChanges& changes, const float* mean_counts,
                   float contrast);

  std::size_t memoryBytes() const;

 private:
  static constexpr std::size_t kLevels = 3;
  static constexpr std::size_t kWeights = ImageMotion::kParts;
  static constexpr std::size_t kResiduals = kWeights + 1;

  /// Log intensity and its gradient beside each other, so that one load brings them.
  struct Texel {
    float value;
    float x;
    float y;
    float unused;
  };
  struct Level {
    SensorSize size;
    std::vector<float> log_image;
    std::vector<float> count;
    std::array<std::vector<float>, EventChanges::kInstants> change;
    std::vector<Texel> texels;
    std::vector<std::uint32_t> chosen;  ///< pixels
  };
  struct Equations;
  struct Sums;

  void load(const float* log_image, const EventChanges& changes, const float* mean_counts);
  void smooth(std::vector<float>& plane);
  static void fillTexels(Level& level);
  static void choosePixels(Level& level);
  Sums sumAt(const Level& level, std::size_t instant, float scale, const ImageMotion& motion,
             float spread);
  Equations linearise(const Level& level, float scale, const ImageMotion& motion, float spread);
  void measure(const Equations& equations, FittedMotion& fitted) const;

  SensorSize size_;
  std::array<Level, kLevels> levels_;  ///< the finest first
  std::vector<float> rows_;            ///< scratch
  /// Of the chosen pixels that stay on the image: slopes by the parts, weights, residuals.
  std::array<std::vector<float>, kResiduals + 1> samples_;
};

}  // namespace fast_edi
