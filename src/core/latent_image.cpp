#include "fast_edi/core/latent_image.hpp"

#include "fast_edi/core/parameter_ranges.hpp"

namespace fast_edi {
void validate(const FilterParameters& parameters) {
  requireWithin(limits::kFilterGainRange, parameters.gain.range_log);
  requireWithin(limits::kFilterGainSigma, parameters.gain.spatial_sigma_px);
  requireWithin(limits::kFilterGainRestore, parameters.gain.restore);
  requireWithin(limits::kFrameNoise, parameters.frame_noise_dn);
  requireWithin(limits::kFilterTemporal, parameters.temporal);
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
