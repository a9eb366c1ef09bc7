#include "fast_edi/core/latent_image.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "fast_edi/core/temporal_fusion.hpp"

namespace fast_edi {
namespace {

void requirePositive(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                                ", expected a finite number > 0");
  }
}

}  // namespace

void validate(const FilterParameters& parameters) {
  requirePositive("filter_gain_range", static_cast<double>(parameters.gain.range_log));
  requirePositive("filter_gain_sigma_px", static_cast<double>(parameters.gain.spatial_sigma_px));
  const float restore = parameters.gain.restore;
  if (!(restore >= 0.0F && restore <= GainRestoration::kMaxStrength)) {
    throw std::invalid_argument("filter_gain_restore is " + std::to_string(restore) +
                                ", expected 0 to " + std::to_string(GainRestoration::kMaxStrength));
  }
  requirePositive("frame_noise_dn", parameters.frame_noise_dn);
  if (!(parameters.temporal >= 0.0 && parameters.temporal <= TemporalFusion::kMaxWeight)) {
    throw std::invalid_argument("filter_temporal is " + std::to_string(parameters.temporal) +
                                ", expected 0 to " + std::to_string(TemporalFusion::kMaxWeight));
  }
}

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
  FrameNoiseFilter::Settings settings;
  settings.noise_dn = static_cast<float>(parameters_.frame_noise_dn);
  frame_noise_filter_ = std::make_unique<FrameNoiseFilter>(size_, format_, settings);
}

void LatentImage::write(const ImageView& blurry, float* gain, const CameraResponse& response,
                        const MutableImageView& out) {
  if (!parameters_.enabled) {
    response.applyGain(blurry, gain, out);
    return;
  }
  fit(blurry);
  gain_filter_->apply(gain);
  response.applyGain(blurry, gain, out);
  if (parameters_.frame_noise) {
    frame_noise_filter_->apply({out.data, out.size, out.step, out.format}, out);
  }
}

std::size_t LatentImage::memoryBytes() const {
  return (gain_filter_ ? gain_filter_->memoryBytes() : 0) +
         (frame_noise_filter_ ? frame_noise_filter_->memoryBytes() : 0);
}

}  // namespace fast_edi
