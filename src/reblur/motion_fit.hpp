/// \file
/// Fits the motion of the image during an exposure to the events in it.
///
/// Where the latent image L of mid-exposure has moved by u at another instant (ImageMotion), the
/// log intensity of a pixel has changed by what its events say, S (EventChanges):
///
///     event_share (log L(x + u(x, tau)) - log L(x)) = S(x, tau)
///
/// event_share is 1, or less where the sensor loses events (its pixels have a dead time after each
/// one): without it motions come out too small then. It stands beside the image rather than divides
/// S, as no motion and no events at all would be a solution otherwise. It is fitted last, and used
/// where it leaves less than 0.97 of the residuals' variance and is at least 0.75: noise of the
/// image makes it small, too, but explains little.
///
/// Gauss-Newton over pixels with events at three instants, coarse to fine: some 500, 700 and 1,200
/// of them on images of a quarter, half and full resolution. Residuals r count with weight 1 / (1 +
/// (r / spread)^2)^2. Levels between two thresholds have moved further than their events say; S is
/// raised by up to a quarter where a pixel has few events, as GainFilter does it with gains.
/// Without this all motions come out a tenth too small.
///
/// Deviation. From the normal equations at the end, given the share of events; neighbouring pixels
/// are not independent, and their number counts as a quarter.
///
/// Complexity. O(pixels) for the three levels, then O(instants * steps) for each of those pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "reblur/event_changes.hpp"
#include "reblur/fitted_motion.hpp"
#include "reblur/motion_equations.hpp"

namespace fast_edi {

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
  static constexpr std::size_t kInstants = EventChanges::kInstants;

  struct Level {
    SensorSize size;
    std::vector<float> log_image;
    std::vector<float> count;                          ///< empty in the finest: as given
    std::array<std::vector<float>, kInstants> change;  ///< the same
  };
  /// The chosen pixels of a level, one value each.
  struct Chosen {
    std::vector<std::uint32_t> pixel;
    std::vector<float> x;
    std::vector<float> y;
    std::vector<float> value;  ///< of log_image
    std::array<std::vector<float>, kInstants> change;

    std::size_t size() const { return pixel.size(); }
  };
  /// Planes of samples in whole blocks; what is behind the last sample has no weight.
  enum Plane : std::size_t {
    kGradientX,
    kGradientY,
    kZoom,
    kTurn,
    kTiltX,
    kTiltY,
    kShare,
    kWeight,
    kResidual,
    kPlanes
  };

  void load(const float* log_image, const EventChanges& changes, const float* mean_counts);
  void loadChosen(const EventChanges& changes, const float* mean_counts, std::size_t level);
  void samplePixels(const Level& level, std::size_t instant, float scale,
                    const FittedMotion& fitted);
  MotionEquations::Sums sumAt(const Level& level, std::size_t instant, float scale,
                              const FittedMotion& fitted, float spread);
  MotionEquations linearise(const Level& level, float scale, const FittedMotion& fitted,
                            float spread);
  void findLostEvents(float spread, MotionEquations& equations, FittedMotion& fitted);

  SensorSize size_;
  std::array<Level, kLevels> levels_;  ///< the finest first
  std::vector<float> row_;             ///< scratch
  Chosen chosen_;
  std::vector<float> relative_x_;  ///< of the chosen pixels, in the units of ImageMotion
  std::vector<float> relative_y_;
  std::vector<float> moved_x_;  ///< of them, where they have moved to, in pixels of the level
  std::vector<float> moved_y_;
  std::array<std::vector<float>, kPlanes> samples_;
};

}  // namespace fast_edi
