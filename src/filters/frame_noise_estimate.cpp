#include "fast_edi/filters/frame_noise_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "base/vector_clones.hpp"
#include "fast_edi/base/image_plane.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kBlock_px = 8;
constexpr std::size_t kPercentile = 20;
/// sqrt(12 / pi): the mean absolute response of (1, -2, 1) to white noise of unit variance.
constexpr float kResponse = 1.9544100F;
/// The mean of a block scatters about that of all: its 20th percentile lies lower by this factor.
constexpr float kPercentileOfMean = 0.92F;
constexpr float kMaxLevel_dn = 255.0F;

/// Adds a row to what each column of a block adds up to.
FAST_EDI_VECTOR_CLONES
void addRow(const float* __restrict row, std::size_t count, std::size_t stride,
            float* __restrict response, float* __restrict lowest, float* __restrict highest) {
  for (std::size_t i = 0; i < count; ++i) {
    const float left = row[i];
    const float right = row[i + 2 * stride];
    response[i] += std::fabs(left - 2.0F * row[i + stride] + right);
    lowest[i] = std::min(lowest[i], std::min(left, right));
    highest[i] = std::max(highest[i], std::max(left, right));
  }
}

}  // namespace

/// Takes the means of the blocks from a row of the plane on, those that can be judged.
void FrameNoiseEstimate::takeBlocks(const float* row, std::size_t width, std::size_t stride,
                                    float saturated) {
  if (width < kBlock_px + 2 * stride) {
    return;
  }
  const std::size_t columns = width - 2 * stride;
  response_.assign(columns, 0.0F);
  lowest_.assign(columns, saturated);
  highest_.assign(columns, 0.0F);
  for (std::size_t y = 0; y < kBlock_px; ++y) {
    addRow(row + y * width, columns, stride, response_.data(), lowest_.data(), highest_.data());
  }
  for (std::size_t x = 0; x + kBlock_px <= columns; x += kBlock_px) {
    float sum = 0.0F;
    bool cut_off = false;
    for (std::size_t i = x; i < x + kBlock_px; ++i) {
      sum += response_[i];
      cut_off |= lowest_[i] <= 0.0F || highest_[i] >= saturated;
    }
    if (!cut_off) {
      block_means_.push_back(sum / static_cast<float>(kBlock_px * kBlock_px));
    }
  }
}

float FrameNoiseEstimate::of(const ImageView& frame) {
  const auto dn = static_cast<float>(dnPerDn8(frame.format));
  const std::size_t stride = isBayer(frame.format) ? 2 : 1;
  const auto width = static_cast<std::size_t>(frame.size.width);
  const auto height = static_cast<std::size_t>(frame.size.height);
  plane_.resize(frame.size.pixelCount());
  block_means_.clear();
  for (int channel = 0; channel < channels(frame.format); ++channel) {
    loadPlane(frame, channel, plane_.data());
    for (std::size_t y = 0; y + kBlock_px <= height; y += kBlock_px) {
      takeBlocks(plane_.data() + y * width, width, stride, kMaxLevel_dn * dn);
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
