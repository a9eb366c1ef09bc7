#include "reblur/reblur.hpp"

#include <algorithm>
#include <cmath>

#include "fast_edi/base/image_plane.hpp"
#include "reblur/log_levels.hpp"

namespace fast_edi {
namespace {

/// A shorter path leaves little to gain.
constexpr float kShortestPath_px = 1.5F;
/// The margin of the scene is not made larger.
constexpr float kLongestReach_px = 40.0F;
constexpr float kLargestDeviation_px = 0.4F;
/// Of the path: a blur that is taken for longer than it is gets sharpened too much.
constexpr float kLargestDeviation = 0.08F;
/// Instants of the blur: one for so much of the path.
constexpr float kInstantsApart_px = 2.5F;
constexpr float kFewestInstants = 4.0F;
constexpr float kMostInstants = 7.0F;
constexpr float kMaxDn8 = 255.0F;
/// Of the image's sides: the coarsest level has a quarter of it.
constexpr int kSmallestSide_px = 32;

bool isUsable(const FittedMotion& fitted) {
  return fitted.found && fitted.path_px >= kShortestPath_px &&
         fitted.reach_px <= kLongestReach_px && fitted.deviation_px <= kLargestDeviation_px &&
         fitted.deviation_px <= kLargestDeviation * fitted.path_px;
}

std::size_t instantsFor(float path_px) {
  return static_cast<std::size_t>(
      std::clamp(std::ceil(path_px / kInstantsApart_px), kFewestInstants, kMostInstants));
}

}  // namespace

/// Levels without the noise that stays in the image [8-bit DN].
const float* Reblur::loadLevels(const Frame& frame, float dn) {
  const float* levels = frame.clean_dn != nullptr ? frame.clean_dn : blended_.data();
  if (dn == 1.0F) {
    return levels;
  }
  level_dn_.resize(blended_.size());
  std::transform(levels, levels + level_dn_.size(), level_dn_.begin(),
                 [dn](float level) { return level * (1.0F / dn); });
  return level_dn_.data();
}

void Reblur::fitMotion(const Frame& frame, const float* level_dn, const PixelEventLists& lists,
                       const LatentGains::Model& model, float offset_dn) {
  constexpr double kHalf = 0.5;
  log_.resize(blended_.size());
  logLevels(level_dn, log_.size(), offset_dn, log_.data());
  changes_.measure(lists, frame.window, frame.counts, *frame.quarters, model);
  const auto contrast = static_cast<float>(kHalf * (model.thresholds.on + model.thresholds.off));
  fitted_ = fit_->fit(log_.data(), changes_, frame.mean_counts, contrast);
}

void Reblur::apply(const Frame& frame, const PixelEventLists& lists,
                   const LatentGains::Model& model, const CameraResponse& response,
                   const MutableImageView& image) {
  constexpr double kHalf = 0.5;
  if (std::min(image.size.width, image.size.height) < kSmallestSide_px) {
    trust_.clear(image.size);
    return;
  }
  if (!fit_ || size_ != image.size) {
    size_ = image.size;
    fit_ = std::make_unique<MotionFit>(size_);
  }
  const auto dn = static_cast<float>(dnPerDn8(image.format));
  const auto offset_dn = static_cast<float>(response.offsetDn());
  blended_.resize(size_.pixelCount());
  loadPlane({image.data, image.size, image.step, image.format}, 0, blended_.data());
  const float* level_dn = loadLevels(frame, dn);
  fitMotion(frame, level_dn, lists, model, offset_dn);
  if (!isUsable(fitted_)) {
    trust_.clear(size_);
    return;
  }
  blur_.set(fitted_.motion, SceneLayout(size_, fitted_.reach_px), instantsFor(fitted_.path_px));
  solver_.solve({frame.blurry_dn, level_dn, frame.mean_counts, frame.noise_dn, offset_dn}, blur_);
  const auto contrast = static_cast<float>(kHalf * (model.thresholds.on + model.thresholds.off));
  trust_.measure(
      {fitted_.motion, changes_, fitted_.event_share, contrast, frame.noise_dn, offset_dn},
      blur_.layout(), solver_);
  blend(dn);
  storePlane(blended_.data(), 0, image);
}

/// Moves the image to the solution as far as that is trusted. Noise that stayed in the image goes
/// there: the solution has its own. Where it is not trusted at all, levels stay whole numbers of
/// the image's own unit, whose bits come back.
void Reblur::blend(float dn) {
  const SceneLayout& layout = blur_.layout();
  const auto width = static_cast<std::size_t>(size_.width);
  for (std::size_t y = 0; y < layout.rows(); ++y) {
    const float* solution = solver_.solution().data() + layout.inScene(0, y);
    const float* trust = trust_.trust().data() + y * width;
    float* level = blended_.data() + y * width;
    for (std::size_t x = 0; x < width; ++x) {
      const float moved = level[x] + trust[x] * (dn * solution[x] - level[x]);
      level[x] = std::clamp(moved, 0.0F, kMaxDn8 * dn);
    }
  }
}

std::size_t Reblur::memoryBytes() const {
  return changes_.memoryBytes() + (fit_ ? fit_->memoryBytes() : 0) + blur_.memoryBytes() +
         solver_.memoryBytes() + trust_.memoryBytes() +
         (level_dn_.capacity() + blended_.capacity() + log_.capacity()) * sizeof(float);
}

}  // namespace fast_edi
