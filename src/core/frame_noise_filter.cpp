#include "fast_edi/core/frame_noise_filter.hpp"

#include <cstring>

namespace fast_edi {
namespace {

/// Differences up to about this many standard deviations are taken for noise. Chosen by PSNR on
/// simulated sequences; 3 to 5 differ by less than 0.1 dB.
constexpr float kRangeInNoise = 3.0F;
/// 16-bit DN for one 8-bit DN: 65535 / 255.
/// Truncation rounds to nearest after this is added to a number that is not negative. A weighted
/// mean of levels lies within their range, so nothing needs to be clamped.
constexpr float kHalf = 0.5F;

template <typename Level>
void loadRow(const std::uint8_t* in, std::size_t count, std::size_t channels, float* out) {
  for (std::size_t i = 0; i < count; ++i) {
    Level level;
    std::memcpy(&level, in + i * channels * sizeof(Level), sizeof(Level));
    out[i] = static_cast<float>(level);
  }
}

template <typename Level>
void storeRow(const float* in, std::size_t count, std::size_t channels, std::uint8_t* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto level = static_cast<Level>(static_cast<int>(in[i] + kHalf));
    std::memcpy(out + i * channels * sizeof(Level), &level, sizeof(Level));
  }
}

EdgePreservingFilter::Settings filterSettings(PixelFormat format,
                                              const FrameNoiseFilter::Settings& settings) {
  const float dn = format == PixelFormat::kMono16 ? static_cast<float>(kDn16PerDn8) : 1.0F;
  return {kRangeInNoise * settings.noise_dn * dn, settings.spatial_sigma_px,
          format == PixelFormat::kBayer8 ? 2 : 1};
}

}  // namespace

FrameNoiseFilter::FrameNoiseFilter(SensorSize size, PixelFormat format, const Settings& settings)
    : size_(size),
      format_(format),
      filter_(size, filterSettings(format, settings)),
      plane_(size.pixelCount()) {}

void FrameNoiseFilter::apply(const ImageView& in, const MutableImageView& out) {
  const bool wide = format_ == PixelFormat::kMono16;
  const auto width = static_cast<std::size_t>(size_.width);
  const auto channel_count = static_cast<std::size_t>(channels(format_));
  for (std::size_t channel = 0; channel < channel_count; ++channel) {
    for (int y = 0; y < size_.height; ++y) {
      float* row = plane_.data() + static_cast<std::size_t>(y) * width;
      if (wide) {
        loadRow<std::uint16_t>(in.row(y), width, channel_count, row);
      } else {
        loadRow<std::uint8_t>(in.row(y) + channel, width, channel_count, row);
      }
    }
    filter_.apply(plane_.data(), plane_.data());
    for (int y = 0; y < size_.height; ++y) {
      const float* row = plane_.data() + static_cast<std::size_t>(y) * width;
      if (wide) {
        storeRow<std::uint16_t>(row, width, channel_count, out.row(y));
      } else {
        storeRow<std::uint8_t>(row, width, channel_count, out.row(y) + channel);
      }
    }
  }
}

}  // namespace fast_edi
