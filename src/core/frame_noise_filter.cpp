#include "fast_edi/core/frame_noise_filter.hpp"

#include "fast_edi/core/image_plane.hpp"
#include "fast_edi/core/stored_image.hpp"

namespace fast_edi {
namespace {

/// Differences up to about this many standard deviations are taken for noise. Chosen by PSNR on
/// simulated sequences; 3 to 5 differ by less than 0.1 dB.
constexpr float kRangeInNoise = 3.0F;

EdgePreservingFilter::Settings filterSettings(PixelFormat format,
                                              const FrameNoiseFilter::Settings& settings) {
  const float dn = static_cast<float>(dnPerDn8(format));
  return {kRangeInNoise * settings.noise_dn * dn, settings.spatial_sigma_px,
          isBayer(format) ? 2 : 1};
}

}  // namespace

FrameNoiseFilter::FrameNoiseFilter(SensorSize size, PixelFormat format, const Settings& settings)
    : size_(size),
      format_(format),
      filter_(size, filterSettings(format, settings)),
      plane_(size.pixelCount()) {}

void FrameNoiseFilter::apply(const ImageView& in, const MutableImageView& out) {
  if (hasAlpha(format_) && in.data != out.data) {
    copyPixels(in, out);
  }
  for (int channel = 0; channel < channels(format_); ++channel) {
    loadPlane(in, channel, plane_.data());
    // A weighted mean of levels lies within their range, so nothing needs to be clamped.
    filter_.apply(plane_.data(), plane_.data());
    storePlane(plane_.data(), channel, out);
  }
}

}  // namespace fast_edi
