#include "fast_edi/filters/frame_noise_filter.hpp"

#include <cmath>

#include "base/vector_clones.hpp"
#include "fast_edi/base/image_plane.hpp"
#include "fast_edi/base/stored_image.hpp"

namespace fast_edi {
namespace {

// Chosen by PSNR and feature inliers on simulated sequences.
constexpr float kFrameNoise = 1.5F;     ///< of the measured one
constexpr float kGainNoise = 0.02F;     ///< of a level with events, relative
constexpr float kTriplingCount = 3.0F;  ///< so many events double that variance

constexpr int kWindowRadius = 1;
constexpr float kSpatialSigma = 1.5F;
constexpr float kMaxLevel_dn = 255.0F;
constexpr float kHalf = 0.5F;

NonLocalMeans::Settings filterSettings(PixelFormat format) {
  return {kWindowRadius, kSpatialSigma, isBayer(format) ? 2 : 1};
}

FAST_EDI_VECTOR_CLONES
void variances(const float* __restrict level, const float* __restrict mean_count, std::size_t count,
               float frame, float* __restrict variance) {
  for (std::size_t i = 0; i < count; ++i) {
    const float n = mean_count[i];
    const float some = kHalf * ((n + 1.0F) - std::fabs(n - 1.0F));  // min(1, n)
    const float relative = kGainNoise * level[i];
    variance[i] = frame + relative * relative * some * (1.0F + n * (1.0F / kTriplingCount));
  }
}

FAST_EDI_VECTOR_CLONES
void keepPart(const float* __restrict clean, std::size_t count, float kept,
              float* __restrict level) {
  for (std::size_t i = 0; i < count; ++i) {
    level[i] = clean[i] + kept * (level[i] - clean[i]);
  }
}

FAST_EDI_VECTOR_CLONES
void keepSaturated(const float* __restrict level, std::size_t count, float highest,
                   float* __restrict filtered) {
  for (std::size_t i = 0; i < count; ++i) {
    filtered[i] = level[i] >= highest ? level[i] : filtered[i];
  }
}

}  // namespace

FrameNoiseFilter::FrameNoiseFilter(SensorSize size, PixelFormat format, double kept)
    : size_(size),
      format_(format),
      kept_(static_cast<float>(kept)),
      filter_(size, filterSettings(format)),
      plane_(size.pixelCount()),
      variance_(size.pixelCount()),
      clean_(size.pixelCount()) {}

void FrameNoiseFilter::apply(const ImageView& in, float noise_dn, const float* mean_count,
                             const MutableImageView& out) {
  if (hasAlpha(format_) && in.data != out.data) {
    copyPixels(in, out);
  }
  const auto dn = static_cast<float>(dnPerDn8(format_));
  const float sigma = kFrameNoise * noise_dn * dn;
  const std::size_t pixels = plane_.size();
  for (int channel = 0; channel < channels(format_); ++channel) {
    loadPlane(in, channel, plane_.data());
    variances(plane_.data(), mean_count, pixels, sigma * sigma, variance_.data());
    filter_.apply(plane_.data(), variance_.data(), clean_.data());
    keepSaturated(plane_.data(), pixels, kMaxLevel_dn * dn, clean_.data());
    keepPart(clean_.data(), pixels, kept_, plane_.data());
    // A weighted mean of levels lies within their range, so nothing needs to be clamped.
    storePlane(plane_.data(), channel, out);
  }
}

}  // namespace fast_edi
