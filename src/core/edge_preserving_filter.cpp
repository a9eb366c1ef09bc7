#include "fast_edi/core/edge_preserving_filter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fast_edi/core/number_text.hpp"
#include "range_weight.hpp"
#include "vector_clones.hpp"

namespace fast_edi {
namespace {

constexpr int kDiameter = 2 * EdgePreservingFilter::kRadius + 1;

/// Adds one row of neighbours (dx = -2..2) to the sums of one row of pixels.
/// \param centre the row of pixels
/// \param neighbours the row of neighbours at dx = 0
/// \param spatial distance weights for dx = -2..2, times kRangeWeightScale
FAST_EDI_VECTOR_CLONES
void addNeighbours(const float* __restrict centre, const float* __restrict neighbours,
                   std::size_t width, std::ptrdiff_t stride, float inverse_range,
                   const float* __restrict spatial, float* __restrict weighted,
                   float* __restrict weight) {
  for (std::size_t x = 0; x < width; ++x) {
    const float p = centre[x];
    float sum = 0.0F;
    float sum_weight = 0.0F;
    for (int k = 0; k < kDiameter; ++k) {
      const float d = neighbours[static_cast<std::ptrdiff_t>(x) +
                                 (k - EdgePreservingFilter::kRadius) * stride] -
                      p;
      const float root = rangeWeightRoot(d, inverse_range);
      const float w = spatial[k] * root * root;
      sum += w * d;
      sum_weight += w;
    }
    weighted[x] += sum;
    weight[x] += sum_weight;
  }
}

FAST_EDI_VECTOR_CLONES
void addMeans(const float* __restrict centre, const float* __restrict weighted,
              const float* __restrict weight, std::size_t width, float* __restrict out) {
  for (std::size_t x = 0; x < width; ++x) {
    out[x] = centre[x] + weighted[x] / weight[x];
  }
}

}  // namespace

EdgePreservingFilter::EdgePreservingFilter(SensorSize size, const Settings& settings)
    : size_(size),
      settings_(settings),
      margin_px_(kRadius * settings.stride_px),
      padded_width_(static_cast<std::size_t>(size.width + 2 * margin_px_)) {
  const auto require = [](const char* name, float sigma) {
    if (!std::isfinite(sigma) || sigma < kMinSigma) {
      throw std::invalid_argument(
          std::string(name) + " is " + numberText(static_cast<double>(sigma)) +
          ", expected a finite number of at least " + numberText(static_cast<double>(kMinSigma)));
    }
  };
  require("range sigma", settings.range_sigma);
  require("spatial sigma", settings.spatial_sigma);
  if (settings.stride_px != 1 && settings.stride_px != 2) {
    throw std::invalid_argument("stride is " + std::to_string(settings.stride_px) +
                                " px, expected 1 or 2");
  }
  padded_.resize(padded_width_ * static_cast<std::size_t>(size.height + 2 * margin_px_));
  weighted_.resize(static_cast<std::size_t>(size.width));
  weight_.resize(static_cast<std::size_t>(size.width));
}

std::size_t EdgePreservingFilter::memoryBytes() const {
  return (padded_.capacity() + weighted_.capacity() + weight_.capacity()) * sizeof(float);
}

/// Copies the plane into the middle of the padded one. With a stride, the pixel that stands in for
/// one beyond the border has the same colour.
void EdgePreservingFilter::pad(const float* in) {
  const auto inside = [this](int i, int length) {
    while (i < 0) i += settings_.stride_px;
    while (i >= length && i >= settings_.stride_px) i -= settings_.stride_px;
    return std::min(i, length - 1);
  };
  for (int y = -margin_px_; y < size_.height + margin_px_; ++y) {
    const float* source = in + static_cast<std::size_t>(inside(y, size_.height)) *
                                   static_cast<std::size_t>(size_.width);
    float* row = padded_.data() + static_cast<std::size_t>(y + margin_px_) * padded_width_;
    std::copy(source, source + size_.width, row + margin_px_);
    for (int x = 1; x <= margin_px_; ++x) {
      row[margin_px_ - x] = source[inside(-x, size_.width)];
      row[margin_px_ + size_.width - 1 + x] = source[inside(size_.width - 1 + x, size_.width)];
    }
  }
}

void EdgePreservingFilter::apply(const float* in, float* out) {
  pad(in);
  const float inverse_range = inverseRange(settings_.range_sigma);
  const float inverse_space = 1.0F / (2.0F * settings_.spatial_sigma * settings_.spatial_sigma);
  const auto width = static_cast<std::size_t>(size_.width);
  const auto stride = static_cast<std::ptrdiff_t>(settings_.stride_px);
  for (int y = 0; y < size_.height; ++y) {
    const float* centre =
        padded_.data() + static_cast<std::size_t>(y + margin_px_) * padded_width_ + margin_px_;
    std::fill(weighted_.begin(), weighted_.end(), 0.0F);
    std::fill(weight_.begin(), weight_.end(), 0.0F);
    for (int dy = -kRadius; dy <= kRadius; ++dy) {
      float spatial[kDiameter];
      for (int dx = -kRadius; dx <= kRadius; ++dx) {
        spatial[dx + kRadius] =
            kRangeWeightScale * std::exp(-static_cast<float>(dx * dx + dy * dy) * inverse_space);
      }
      const float* neighbours = centre + dy * stride * static_cast<std::ptrdiff_t>(padded_width_);
      addNeighbours(centre, neighbours, width, stride, inverse_range, spatial, weighted_.data(),
                    weight_.data());
    }
    addMeans(centre, weighted_.data(), weight_.data(), width,
             out + static_cast<std::size_t>(y) * width);
  }
}

}  // namespace fast_edi
