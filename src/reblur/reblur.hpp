/// \file
/// Recovers what causes no events, where the motion is known from the events of other pixels.
///
/// Pixels below the contrast threshold keep the frame's blur. But the image moves as a whole, and
/// the events elsewhere show how. With that motion the blur is a known linear operator, and the
/// latent image is moved towards what re-blurring it leaves unexplained in the frame:
///
///     EventChanges -> MotionFit -> MovingBlur -> ResidualSolver -> TrustMap -> image
///
/// Nothing is touched while the motion is not known well enough (see isUsable()), and no pixel
/// whose trust is 0.
///
/// Limits. Monochrome frames of a linear camera response whose latent image shows mid-exposure; one
/// motion for the whole image, of at least 32 x 32 pixels.
///
/// Complexity. O(pixels); memory once used about 115 B per pixel.
#pragma once

#include <memory>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/integral/latent_gains.hpp"
#include "fast_edi/latent/camera_response.hpp"
#include "reblur/event_changes.hpp"
#include "reblur/later_quarters.hpp"
#include "reblur/motion_fit.hpp"
#include "reblur/moving_blur.hpp"
#include "reblur/residual_solver.hpp"
#include "reblur/trust_map.hpp"

namespace fast_edi {

class Reblur {
 public:
  /// What the default's filters know of a frame.
  struct Frame {
    ExposureInterval window;                  ///< in event time
    const float* blurry_dn = nullptr;         ///< its levels, row-major [8-bit DN]
    const float* mean_counts = nullptr;       ///< events of each pixel, mean over 3 x 3 pixels
    float noise_dn = 0.0F;                    ///< standard deviation [8-bit DN]
    const std::uint16_t* counts = nullptr;    ///< OFF and ON events of each pixel, interleaved
    const LaterQuarters* quarters = nullptr;  ///< of the window
    /// Levels of the latent image without the noise that stays in it, row-major [DN of the image];
    /// null: as in the image.
    const float* clean_dn = nullptr;
  };

  static bool supports(PixelFormat format, const CameraResponse& response) {
    return (format == PixelFormat::kMono8 || format == PixelFormat::kMono16) && response.isLinear();
  }

  /// \param lists of the frame's size; they hold the events of the window, and keep intervals
  ///        unless the level model is the staircase
  /// \param image latent image at mid-exposure; changed in place
  /// \pre supports()
  void apply(const Frame& frame, const PixelEventLists& lists, const LatentGains::Model& model,
             const CameraResponse& response, const MutableImageView& image);

  /// How far each pixel was trusted in the last apply(), 0 to 1, row-major.
  const std::vector<float>& trust() const { return trust_.trust(); }
  const FittedMotion& motion() const { return fitted_; }
  std::size_t memoryBytes() const;

 private:
  const float* loadLevels(const Frame& frame, float dn);
  void fitMotion(const Frame& frame, const float* level_dn, const PixelEventLists& lists,
                 const LatentGains::Model& model, float offset_dn);
  void blend(float dn);

  SensorSize size_;
  EventChanges changes_;
  std::unique_ptr<MotionFit> fit_;
  FittedMotion fitted_;
  MovingBlur blur_;
  ResidualSolver solver_;
  TrustMap trust_;
  std::vector<float> level_dn_;  ///< of images whose unit is another one
  std::vector<float> blended_;   ///< [DN of the image]
  std::vector<float> log_;
};

}  // namespace fast_edi
