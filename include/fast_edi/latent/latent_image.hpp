/// \file
/// The last stage: from a blurry frame and the gains of its pixels to the latent image.
///
///     gains -> GainFilter -> saturated pixels -> CameraResponse::applyGain -> FrameNoiseFilter
///     -> outgoing image
///
/// The filters are what goes beyond plain EDI; each can be switched off, all with
/// FilterParameters::enabled.
///
/// Saturated pixels. A level cut off at the highest digital number is a lower bound of the mean
/// over the exposure. A gain little below 1 (lamps that flicker) would turn it grey without cause,
/// so it counts as 1; a gain of less than 1/4 says that something bright has moved away, and stays.
#pragma once

#include <memory>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/filters/exposure_events.hpp"
#include "fast_edi/filters/filter_parameters.hpp"
#include "fast_edi/filters/frame_noise_estimate.hpp"
#include "fast_edi/filters/frame_noise_filter.hpp"
#include "fast_edi/filters/gain_filter.hpp"
#include "fast_edi/latent/camera_response.hpp"

namespace fast_edi {

class LatentImage {
 public:
  explicit LatentImage(const FilterParameters& parameters);

  /// Changes parameters; the filters are rebuilt when next used.
  void setParameters(const FilterParameters& parameters);

  /// \param gain width x height gains of DoubleIntegral::integrate(); filtered in place
  /// \param events of the exposure of the blurry frame
  /// \pre blurry and out have the same size and format
  void write(const ImageView& blurry, float* gain, const ExposureEvents& events,
             const CameraResponse& response, const MutableImageView& out);

  // Of the last write() with filters:

  /// Levels of the blurry frame [8-bit DN], row-major; of several channels the lowest.
  const std::vector<float>& blurryLevels() const { return level_dn_; }
  /// Events of each pixel, mean over 3 x 3 pixels.
  const float* meanCounts() const { return gain_filter_->meanCounts(); }
  /// Levels of the latent image without any noise of the frame, row-major [DN], of monochrome
  /// images; null where the frame's noise is not filtered.
  const float* cleanLevels() const {
    return parameters_.frame_noise ? frame_noise_filter_->clean().data() : nullptr;
  }
  /// Standard deviation of the frame's noise, given or measured [8-bit DN].
  float frameNoise() const { return noise_dn_; }

  std::size_t memoryBytes() const;

 private:
  void fit(const ImageView& blurry);
  void loadLevels(const ImageView& blurry);
  void raiseSaturated(float* gain) const;

  FilterParameters parameters_;
  SensorSize size_;
  PixelFormat format_ = PixelFormat::kMono8;
  std::unique_ptr<GainFilter> gain_filter_;
  std::unique_ptr<FrameNoiseFilter> frame_noise_filter_;
  FrameNoiseEstimate noise_estimate_;
  std::vector<float> level_dn_;  ///< of the blurry frame [8-bit DN]; the lowest of its channels
  std::vector<float> channel_dn_;
  float noise_dn_ = 0.0F;
};

}  // namespace fast_edi
