#include "fast_edi/filters/non_local_means.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

constexpr int kPatchRadius = 1;
constexpr float kPatchPixels = 9.0F;

FAST_EDI_VECTOR_CLONES
void squaredDifferences(const float* __restrict a, const float* __restrict b, std::size_t count,
                        float* __restrict squares) {
  for (std::size_t i = 0; i < count; ++i) {
    const float d = a[i] - b[i];
    squares[i] = d * d;
  }
}

FAST_EDI_VECTOR_CLONES
void sumOfThree(const float* __restrict in, std::size_t count, std::size_t stride,
                float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) {
    sums[i] = in[i] + in[i + stride] + in[i + 2 * stride];
  }
}

/// Weights of pairs, and those times the difference of their values.
FAST_EDI_VECTOR_CLONES
void weighPairs(const float* __restrict above, const float* __restrict middle,
                const float* __restrict below, const float* __restrict precision_p,
                const float* __restrict precision_q, const float* __restrict p,
                const float* __restrict q, std::size_t count, float spatial,
                float* __restrict weight, float* __restrict weighted) {
  for (std::size_t i = 0; i < count; ++i) {
    const float r = (above[i] + middle[i] + below[i]) * (precision_p[i] + precision_q[i]);
    // max(0, 1 - max(0, r - 1) / 4), twice; without comparisons, which keep GCC from vectorising.
    const float t = 1.25F - 0.125F * ((r + 1.0F) + std::fabs(r - 1.0F));
    const float twice = t + std::fabs(t);
    const float squared = twice * twice;
    const float w = spatial * (squared * squared);
    weight[i] = w;
    weighted[i] = w * (q[i] - p[i]);
  }
}

FAST_EDI_VECTOR_CLONES
void addTo(const float* __restrict in, std::size_t count, float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) {
    sums[i] += in[i];
  }
}

FAST_EDI_VECTOR_CLONES
void subtractFrom(const float* __restrict in, std::size_t count, float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) {
    sums[i] -= in[i];
  }
}

FAST_EDI_VECTOR_CLONES
void addMeans(const float* __restrict values, const float* __restrict weighted,
              const float* __restrict weight, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = values[i] + weighted[i] / weight[i];
  }
}

FAST_EDI_VECTOR_CLONES
void precisions(const float* __restrict variance, std::size_t count, float* __restrict precision) {
  constexpr float kScale = 1.0F / (4.0F * kPatchPixels);
  for (std::size_t i = 0; i < count; ++i) {
    precision[i] = kScale / variance[i];
  }
}

/// weighPairs() computes sixteen times the weight.
constexpr float kPairWeightScale = 1.0F / 16.0F;

}  // namespace

NonLocalMeans::NonLocalMeans(SensorSize size, const Settings& settings)
    : size_(size),
      settings_(settings),
      margin_px_((settings.window_radius + kPatchRadius) * settings.stride_px),
      padded_width_(static_cast<std::size_t>(size.width + 2 * margin_px_)),
      box_rows_(static_cast<std::size_t>(2 * settings.stride_px + 1)) {
  if (settings.window_radius < 1 || settings.window_radius > kMaxWindowRadius) {
    throw std::invalid_argument("window radius is " + std::to_string(settings.window_radius) +
                                ", expected 1 to " + std::to_string(kMaxWindowRadius));
  }
  if (!std::isfinite(settings.spatial_sigma) || settings.spatial_sigma <= 0.0F) {
    throw std::invalid_argument("spatial sigma is " + std::to_string(settings.spatial_sigma) +
                                ", expected a finite number > 0");
  }
  if (settings.stride_px != 1 && settings.stride_px != 2) {
    throw std::invalid_argument("stride is " + std::to_string(settings.stride_px) +
                                " px, expected 1 or 2");
  }
  const int radius = settings.window_radius;
  const float inverse_space = 1.0F / (2.0F * settings.spatial_sigma * settings.spatial_sigma);
  for (int dy = 0; dy <= radius; ++dy) {
    for (int dx = dy == 0 ? 1 : -radius; dx <= radius; ++dx) {
      offsets_.push_back(
          {dx * settings.stride_px, dy * settings.stride_px,
           kPairWeightScale * std::exp(-static_cast<float>(dx * dx + dy * dy) * inverse_space)});
    }
  }
  const std::size_t padded = padded_width_ * static_cast<std::size_t>(size.height + 2 * margin_px_);
  values_.resize(padded);
  precision_.resize(padded);
  weighted_.resize(padded);
  weight_.resize(padded);
  boxes_.resize(offsets_.size() * box_rows_ * padded_width_);
  squares_.resize(padded_width_);
  pair_weight_.resize(padded_width_);
}

std::size_t NonLocalMeans::memoryBytes() const {
  return (values_.capacity() + precision_.capacity() + weighted_.capacity() + weight_.capacity() +
          boxes_.capacity() + squares_.capacity() + pair_weight_.capacity()) *
         sizeof(float);
}

/// Copies a plane into the middle of a padded one. With a stride, the pixel that stands in for one
/// beyond the border has the same colour.
void NonLocalMeans::pad(const float* in, std::vector<float>& padded) const {
  const auto inside = [this](int i, int length) {
    while (i < 0) i += settings_.stride_px;
    while (i >= length && i >= settings_.stride_px) i -= settings_.stride_px;
    return std::min(i, length - 1);
  };
  for (int y = -margin_px_; y < size_.height + margin_px_; ++y) {
    const float* source = in + static_cast<std::size_t>(inside(y, size_.height)) *
                                   static_cast<std::size_t>(size_.width);
    float* row = padded.data() + static_cast<std::size_t>(y + margin_px_) * padded_width_;
    std::copy(source, source + size_.width, row + margin_px_);
    for (int x = 1; x <= margin_px_; ++x) {
      row[margin_px_ - x] = source[inside(-x, size_.width)];
      row[margin_px_ + size_.width - 1 + x] = source[inside(size_.width - 1 + x, size_.width)];
    }
  }
}

float* NonLocalMeans::boxRow(std::size_t offset, int row) {
  const std::size_t slot = static_cast<std::size_t>(row) % box_rows_;
  return boxes_.data() + (offset * box_rows_ + slot) * padded_width_;
}

/// Squared differences between a row and the one at an offset, summed over patches' rows. The sum
/// for the pixel at x stands at x - stride of the columns that compare() uses.
void NonLocalMeans::sumDifferences(std::size_t offset, int row) {
  const Offset& o = offsets_[offset];
  const int begin = margin_px_ - std::max(o.dx, 0) - settings_.stride_px;
  const int end = margin_px_ + size_.width + std::max(-o.dx, 0) + settings_.stride_px;
  const auto count = static_cast<std::size_t>(end - begin);
  const float* p = values_.data() + static_cast<std::size_t>(row) * padded_width_ + begin;
  const float* q =
      values_.data() + static_cast<std::size_t>(row + o.dy) * padded_width_ + (begin + o.dx);
  const auto stride = static_cast<std::size_t>(settings_.stride_px);
  squaredDifferences(p, q, count, squares_.data());
  sumOfThree(squares_.data(), count - 2 * stride, stride, boxRow(offset, row));
}

/// Weighs the pixels of a row and those at an offset, for both.
void NonLocalMeans::compare(std::size_t offset, int row) {
  const Offset& o = offsets_[offset];
  const int begin = margin_px_ - std::max(o.dx, 0);
  const auto count =
      static_cast<std::size_t>(margin_px_ + size_.width + std::max(-o.dx, 0) - begin);
  const std::size_t p = static_cast<std::size_t>(row) * padded_width_ +  //
                        static_cast<std::size_t>(begin);
  const std::size_t q =
      static_cast<std::size_t>(row + o.dy) * padded_width_ + static_cast<std::size_t>(begin + o.dx);
  weighPairs(boxRow(offset, row - settings_.stride_px), boxRow(offset, row),
             boxRow(offset, row + settings_.stride_px), precision_.data() + p,
             precision_.data() + q, values_.data() + p, values_.data() + q, count, o.spatial_weight,
             pair_weight_.data(), squares_.data());
  addTo(pair_weight_.data(), count, weight_.data() + p);
  addTo(squares_.data(), count, weighted_.data() + p);
  addTo(pair_weight_.data(), count, weight_.data() + q);
  subtractFrom(squares_.data(), count, weighted_.data() + q);
}

void NonLocalMeans::apply(const float* in, const float* noise_variance, float* out) {
  pad(in, values_);
  pad(noise_variance, precision_);
  precisions(precision_.data(), precision_.size(), weighted_.data());
  precision_.swap(weighted_);
  std::fill(weighted_.begin(), weighted_.end(), 0.0F);
  std::fill(weight_.begin(), weight_.end(), 1.0F);

  const int stride = settings_.stride_px;
  const int first = margin_px_ - settings_.window_radius * stride;
  const int end = margin_px_ + size_.height;
  for (std::size_t offset = 0; offset < offsets_.size(); ++offset) {
    for (int row = first - stride; row < first + stride; ++row) {
      sumDifferences(offset, row);
    }
  }
  for (int row = first; row < end; ++row) {
    for (std::size_t offset = 0; offset < offsets_.size(); ++offset) {
      sumDifferences(offset, row + stride);
      compare(offset, row);
    }
  }
  const auto width = static_cast<std::size_t>(size_.width);
  for (int y = 0; y < size_.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y + margin_px_) * padded_width_ +
                            static_cast<std::size_t>(margin_px_);
    addMeans(values_.data() + row, weighted_.data() + row, weight_.data() + row, width,
             out + static_cast<std::size_t>(y) * width);
  }
}

}  // namespace fast_edi
