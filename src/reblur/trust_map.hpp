/// \file
/// Where an image that was moved towards the residual of re-blurring may be trusted, pixel by pixel
/// from 0 to 1.
///
/// One motion is fitted to the whole image. What moves otherwise, or stands still, must be left as
/// it is, or it is sharpened against a blur that it does not have: ghosts. Three signs, each of
/// which takes trust away:
/// 1. **Residual.** Over 14 x 14 pixels: what remains is neither what the frame's noise explains
///    (mean square up to 1.3 sigma^2, none from 2 sigma^2 on) nor much less than before (a share of
///    0.1 to 0.4 is gone). Detail that is finer than the blur allows is not explained by it.
/// 2. **Events.** The moved image says how each pixel must have changed from mid-exposure to the
///    start, the third quarter and the end, and so do the events (over the share of them that the
///    sensor does not lose, see MotionFit). Where one of both exceeds a threshold c, and both
///    differ by more than c, 0.3 of the larger one, and half of the difference between the pixels
///    around (that is what an error of half a pixel of the motion makes), they contradict. Few such
///    pixels are allowed among 6 x 6.
/// 3. **Neighbourhood.** The share of contradicting pixels among those that could, in some 88 x 88.
///
/// All this on planes of half the resolution (means over 2 x 2 pixels). The result is smoothed over
/// 6 x 6 pixels, interpolated, and 0 below 0.02.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "reblur/event_changes.hpp"
#include "reblur/image_motion.hpp"
#include "reblur/residual_solver.hpp"

namespace fast_edi {

class TrustMap {
 public:
  struct Input {
    const ImageMotion& motion;
    const EventChanges& changes;
    float event_share = 1.0F;  ///< part of the changes that events tell, see FittedMotion
    float contrast = 0.0F;     ///< c
    float noise_dn = 0.0F;     ///< sigma
    float offset_dn = 0.0F;    ///< level + offset is proportional to the light
  };

  void measure(const Input& input, const SceneLayout& layout, const ResidualSolver& solved);
  /// Trust nothing.
  void clear(SensorSize size) { trust_.assign(size.pixelCount(), 0.0F); }

  /// Row-major.
  const std::vector<float>& trust() const { return trust_; }
  std::size_t memoryBytes() const;

 private:
  void halveScene(const Input& input, const SceneLayout& layout, const std::vector<float>& scene);
  void fillTaps(const ImageMotion& motion, const ImageMotion::Parts& c, std::size_t group);
  void findContradictions(const Input& input);
  void explain(const SceneLayout& layout, const ResidualSolver& solved, float noise_dn);
  void judgeNeighbourhood();
  void spread();

  SensorSize size_;   ///< of the image
  SceneLayout half_;  ///< of planes at half the resolution, as all but the last one are
  std::vector<float> log_scene_;
  std::vector<float> row_;
  std::vector<SceneLayout::Tap> taps_;  ///< of a group of rows
  std::vector<std::int32_t> could_;     ///< -1 or 0, as planes of the image in whole blocks
  std::vector<std::int32_t> does_;
  std::vector<float> contradicts_;  ///< 1 or 0, row-major
  std::vector<float> comparable_;
  std::vector<float> before_;
  std::vector<float> after_;
  std::vector<float> rows_;
  std::vector<float> trusted_;
  std::vector<float> trust_;
};

}  // namespace fast_edi
