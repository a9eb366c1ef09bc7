#include "fast_edi/filters/frame_noise_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "fast_edi/base/image_plane.hpp"

namespace fast_edi {
namespace {

constexpr int kBlock_px = 8;
constexpr std::size_t kPercentile = 20;
/// sqrt(12 / pi): the mean absolute response of (1, -2, 1) to white noise of unit variance.
constexpr float kResponse = 1.9544100F;
/// The mean of a block scatters about that of all: its 20th percentile lies lower by this factor.
constexpr float kPercentileOfMean = 0.92F;
constexpr float kMaxLevel_dn = 255.0F;

/// Mean absolute response within a block; negative when it cannot be judged.
/// \param corner upper left pixel of the block
float blockMean(const float* corner, std::size_t width, std::size_t stride, float highest) {
  float sum = 0.0F;
  float lowest_level = highest;
  float highest_level = 0.0F;
  for (std::size_t y = 0; y < kBlock_px; ++y) {
    const float* row = corner + y * width;
    for (std::size_t x = 0; x < kBlock_px; ++x) {
      const float left = row[x];
      const float right = row[x + 2 * stride];
      sum += std::fabs(left - 2.0F * row[x + stride] + right);
      lowest_level = std::min({lowest_level, left, right});
      highest_level = std::max({highest_level, left, right});
    }
  }
  const bool cut_off = lowest_level <= 0.0F || highest_level >= highest;
  return cut_off ? -1.0F : sum / static_cast<float>(kBlock_px * kBlock_px);
}

}  // namespace

float FrameNoiseEstimate::of(const ImageView& frame) {
  const auto dn = static_cast<float>(dnPerDn8(frame.format));
  const int stride = isBayer(frame.format) ? 2 : 1;
  const auto width = static_cast<std::size_t>(frame.size.width);
  plane_.resize(frame.size.pixelCount());
  block_means_.clear();
  for (int channel = 0; channel < channels(frame.format); ++channel) {
    loadPlane(frame, channel, plane_.data());
    for (int y = 0; y + kBlock_px <= frame.size.height; y += kBlock_px) {
      for (int x = 0; x + kBlock_px + 2 * stride <= frame.size.width; x += kBlock_px) {
        const float mean = blockMean(
            plane_.data() + static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x),
            width, static_cast<std::size_t>(stride), kMaxLevel_dn * dn);
        if (mean >= 0.0F) {
          block_means_.push_back(mean);
        }
      }
    }
  }
  if (block_means_.empty()) {
    return kLowest_dn;
  }
  const auto percentile = block_means_.begin() + static_cast<std::ptrdiff_t>(
                                                     (block_means_.size() - 1) * kPercentile / 100);
  std::nth_element(block_means_.begin(), percentile, block_means_.end());
  return std::clamp(*percentile / (kResponse * kPercentileOfMean * dn), kLowest_dn, kHighest_dn);
}

}  // namespace fast_edi
