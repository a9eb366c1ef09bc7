#include "fast_edi/latent/latent_image.hpp"

#include <algorithm>

#include "fast_edi/base/image_plane.hpp"

namespace fast_edi {
namespace {

/// From here on a level is cut off [8-bit DN].
constexpr float kSaturated_dn = 254.0F;
/// Flicker and noise explain no lower gain than this.
constexpr float kUnexplained = 0.5F;
/// A gain this low says that something bright has moved away.
constexpr float kMovedAway = 0.25F;

}  // namespace

LatentImage::LatentImage(const FilterParameters& parameters) : parameters_(parameters) {}

void LatentImage::setParameters(const FilterParameters& parameters) {
  parameters_ = parameters;
  gain_filter_.reset();
  frame_noise_filter_.reset();
}

/// Builds the filters when parameters, size or format have changed.
void LatentImage::fit(const ImageView& blurry) {
  if (gain_filter_ && size_ == blurry.size && format_ == blurry.format) {
    return;
  }
  size_ = blurry.size;
  format_ = blurry.format;
  gain_filter_ = std::make_unique<GainFilter>(size_, parameters_.gain);
  frame_noise_filter_ =
      std::make_unique<FrameNoiseFilter>(size_, format_, parameters_.frame_noise_kept);
}

/// Of several channels the lowest counts: a pixel is saturated where all of them are.
void LatentImage::loadLevels(const ImageView& blurry) {
  level_dn_.resize(blurry.size.pixelCount());
  loadPlane(blurry, 0, level_dn_.data());
  for (int channel = 1; channel < channels(blurry.format); ++channel) {
    channel_dn_.resize(level_dn_.size());
    loadPlane(blurry, channel, channel_dn_.data());
    for (std::size_t i = 0; i < level_dn_.size(); ++i) {
      level_dn_[i] = std::min(level_dn_[i], channel_dn_[i]);
    }
  }
  if (bytesPerSample(blurry.format) == 2) {
    for (float& level : level_dn_) {
      level *= 1.0F / static_cast<float>(kDn16PerDn8);
    }
  }
}

void LatentImage::raiseSaturated(float* gain) const {
  for (std::size_t i = 0; i < level_dn_.size(); ++i) {
    if (level_dn_[i] >= kSaturated_dn && gain[i] < 1.0F && gain[i] > kMovedAway) {
      // From 1 at kUnexplained down to the gain itself at kMovedAway.
      const float moved =
          std::clamp((kUnexplained - gain[i]) / (kUnexplained - kMovedAway), 0.0F, 1.0F);
      gain[i] = 1.0F - moved * (1.0F - gain[i]);
    }
  }
}

void LatentImage::write(const ImageView& blurry, float* gain, const ExposureEvents& events,
                        const CameraResponse& response, const MutableImageView& out) {
  if (!parameters_.enabled) {
    response.applyGain(blurry, gain, out);
    return;
  }
  fit(blurry);
  loadLevels(blurry);
  gain_filter_->apply(level_dn_.data(), events, gain);
  raiseSaturated(gain);
  // Before the image is written: it may be written over the blurry one.
  noise_dn_ = parameters_.frame_noise_dn > 0.0 ? static_cast<float>(parameters_.frame_noise_dn)
                                               : noise_estimate_.of(blurry);
  response.applyGain(blurry, gain, out);
  if (parameters_.frame_noise) {
    frame_noise_filter_->apply({out.data, out.size, out.step, out.format}, noise_dn_,
                               gain_filter_->meanCounts(), out);
  }
}

std::size_t LatentImage::memoryBytes() const {
  return (gain_filter_ ? gain_filter_->memoryBytes() : 0) +
         (frame_noise_filter_ ? frame_noise_filter_->memoryBytes() : 0) +
         noise_estimate_.memoryBytes() +
         (level_dn_.capacity() + channel_dn_.capacity()) * sizeof(float);
}

}  // namespace fast_edi
