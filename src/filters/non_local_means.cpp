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

/// Loops run over blocks of as many values as the widest registers hold: without a remainder, which
/// would take as long as several blocks. What they compute beyond a row's end is not used.
constexpr std::size_t kBlock = 8;

std::size_t blocksOf(std::size_t count) {
  return (count + kBlock - 1) / kBlock;
}

/// Squared differences of two rows, and their sums with those of the two rows above.
FAST_EDI_VECTOR_CLONES
void addSquares(const float* __restrict a, const float* __restrict b,
                const float* __restrict two_above, const float* __restrict above,
                std::size_t blocks, float* __restrict squares, float* __restrict columns) {
  for (std::size_t i = 0; i < blocks * kBlock; ++i) {
    const float d = a[i] - b[i];
    const float square = d * d;
    squares[i] = square;
    columns[i] = two_above[i] + above[i] + square;
  }
}

/// Weights of pairs, from sums of squares over columns of their patches.
/// \param stride from one column of a patch to the next
/// \param spatial_root fourth root of the spatial weight
FAST_EDI_VECTOR_CLONES
void weighPairs(const float* __restrict columns, std::size_t stride,
                const float* __restrict precision_p, const float* __restrict precision_q,
                std::size_t blocks, float spatial_root, float* __restrict weight) {
  const float slope = 0.25F * spatial_root;
  const float start = spatial_root + slope;
  for (std::size_t i = 0; i < blocks * kBlock; ++i) {
    const float sum = columns[i] + columns[i + stride] + columns[i + 2 * stride];
    const float r = sum * (precision_p[i] + precision_q[i]);
    const float root = std::max(0.0F, std::min(spatial_root, start - slope * r));
    const float squared = root * root;
    weight[i] = squared * squared;
  }
}

/// Rows of the pixels at an offset and at the opposite one from those of a row, and the weights of
/// both.
struct Neighbours {
  const float* ahead;
  const float* ahead_weight;
  const float* behind;
  const float* behind_weight;
};

/// Offsets that addNeighbours() takes at once; every window has a multiple of them.
constexpr std::size_t kOffsetsAtOnce = 4;

/// Adds weights, and those times the difference to the pixel itself.
FAST_EDI_VECTOR_CLONES
void addNeighbours(const Neighbours* neighbours, const float* __restrict values, std::size_t blocks,
                   float* __restrict weighted, float* __restrict weight) {
  const Neighbours a = neighbours[0];
  const Neighbours b = neighbours[1];
  const Neighbours c = neighbours[2];
  const Neighbours d = neighbours[3];
  const auto sum_of = [](const Neighbours& n, std::size_t i, float value) {
    return n.ahead_weight[i] * (n.ahead[i] - value) + n.behind_weight[i] * (n.behind[i] - value);
  };
  const auto weight_of = [](const Neighbours& n, std::size_t i) {
    return n.ahead_weight[i] + n.behind_weight[i];
  };
  for (std::size_t i = 0; i < blocks * kBlock; ++i) {
    const float value = values[i];
    weighted[i] += (sum_of(a, i, value) + sum_of(b, i, value)) +  //
                   (sum_of(c, i, value) + sum_of(d, i, value));
    weight[i] += (weight_of(a, i) + weight_of(b, i)) + (weight_of(c, i) + weight_of(d, i));
  }
}

FAST_EDI_VECTOR_CLONES
void addMeans(const float* __restrict values, const float* __restrict weighted,
              const float* __restrict weight, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = values[i] + weighted[i] / weight[i];
  }
}

/// Of variances, in place: 1 / (36 s^2).
FAST_EDI_VECTOR_CLONES
void invert(std::size_t count, float* __restrict variance) {
  constexpr float kScale = 1.0F / (4.0F * kPatchPixels);
  for (std::size_t i = 0; i < count; ++i) {
    variance[i] = kScale / variance[i];
  }
}

}  // namespace

NonLocalMeans::NonLocalMeans(SensorSize size, const Settings& settings)
    : size_(size),
      settings_(settings),
      margin_px_((settings.window_radius + kPatchRadius) * settings.stride_px),
      padded_width_(static_cast<std::size_t>(size.width + 2 * margin_px_)),
      row_floats_(padded_width_ + 2 * kBlock),
      square_rows_(static_cast<std::size_t>(2 * settings.stride_px + 1)),
      weight_rows_(static_cast<std::size_t>(settings.window_radius * settings.stride_px + 1)) {
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
  // The fourth root of exp(-d^2 / (2 sigma^2)) is exp(-d^2 / (8 sigma^2)).
  const float inverse_space = 1.0F / (8.0F * settings.spatial_sigma * settings.spatial_sigma);
  for (int dy = 0; dy <= radius; ++dy) {
    for (int dx = dy == 0 ? 1 : -radius; dx <= radius; ++dx) {
      offsets_.push_back({dx * settings.stride_px, dy * settings.stride_px,
                          std::exp(-static_cast<float>(dx * dx + dy * dy) * inverse_space)});
    }
  }
  // Blocks may begin before a row, and end behind one that is shifted by an offset.
  const std::size_t padded =
      indexOf(0, size.height + 2 * margin_px_) + 2 * kBlock + static_cast<std::size_t>(margin_px_);
  values_.resize(padded);
  precision_.resize(padded);
  squares_.resize(offsets_.size() * square_rows_ * row_floats_);
  columns_.resize(row_floats_);
  pair_weights_.resize(offsets_.size() * weight_rows_ * row_floats_);
  weighted_.resize(row_floats_);
  weight_.resize(row_floats_);
}

std::size_t NonLocalMeans::memoryBytes() const {
  return (values_.capacity() + precision_.capacity() + squares_.capacity() + columns_.capacity() +
          pair_weights_.capacity() + weighted_.capacity() + weight_.capacity()) *
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
    float* row = padded.data() + indexOf(0, y + margin_px_);
    std::copy(source, source + size_.width, row + margin_px_);
    for (int x = 1; x <= margin_px_; ++x) {
      row[margin_px_ - x] = source[inside(-x, size_.width)];
      row[margin_px_ + size_.width - 1 + x] = source[inside(size_.width - 1 + x, size_.width)];
    }
  }
}

/// Of the padded planes, whose first pixel is at (0, 0).
std::size_t NonLocalMeans::indexOf(int x, int y) const {
  return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(kBlock) +
                                  static_cast<std::ptrdiff_t>(y) *
                                      static_cast<std::ptrdiff_t>(padded_width_) +
                                  static_cast<std::ptrdiff_t>(x));
}

/// One of the last \p rows_kept rows of an offset.
float* NonLocalMeans::rowOf(std::vector<float>& rows, std::size_t rows_kept, std::size_t offset,
                            int y) const {
  const std::size_t slot = (static_cast<std::size_t>(y) + rows_kept) % rows_kept;
  return rows.data() + (offset * rows_kept + slot) * row_floats_ + kBlock;
}

/// Squared differences between a row and the one at an offset. Leaves in columns_ their sums with
/// those of the two rows of a patch above.
void NonLocalMeans::addRow(std::size_t offset, int y) {
  const Offset& o = offsets_[offset];
  const auto squares = [this, offset](int i) { return rowOf(squares_, square_rows_, offset, i); };
  addSquares(values_.data() + indexOf(0, y), values_.data() + indexOf(o.dx, y + o.dy),
             squares(y - 2 * settings_.stride_px), squares(y - settings_.stride_px),
             blocksOf(padded_width_), squares(y), columns_.data());
}

/// Weighs the pixels of a row and those at an offset. \pre columns_ are those of the row's patches
void NonLocalMeans::weighRow(std::size_t offset, int y) {
  const Offset& o = offsets_[offset];
  const int stride = settings_.stride_px;
  weighPairs(columns_.data(), static_cast<std::size_t>(stride),
             precision_.data() + indexOf(stride, y),
             precision_.data() + indexOf(stride + o.dx, y + o.dy),
             blocksOf(padded_width_ - 2 * static_cast<std::size_t>(stride)), o.spatial_root,
             rowOf(pair_weights_, weight_rows_, offset, y) + stride);
}

/// \param y of a padded row within the plane
/// \pre the weights of the row and of those that reach it are there
void NonLocalMeans::averageRow(int y, float* out) {
  const auto width = static_cast<std::size_t>(size_.width);
  const float* values = values_.data() + indexOf(margin_px_, y);
  std::fill(weighted_.begin(), weighted_.end(), 0.0F);
  std::fill(weight_.begin(), weight_.end(), 1.0F);
  for (std::size_t first = 0; first < offsets_.size(); first += kOffsetsAtOnce) {
    Neighbours neighbours[kOffsetsAtOnce];
    for (std::size_t i = 0; i < kOffsetsAtOnce; ++i) {
      const Offset& o = offsets_[first + i];
      const auto weights = [this, offset = first + i](int row) {
        return rowOf(pair_weights_, weight_rows_, offset, row) + margin_px_;
      };
      neighbours[i] = {values_.data() + indexOf(margin_px_ + o.dx, y + o.dy), weights(y),
                       values_.data() + indexOf(margin_px_ - o.dx, y - o.dy),
                       weights(y - o.dy) - o.dx};
    }
    addNeighbours(neighbours, values, blocksOf(width), weighted_.data(), weight_.data());
  }
  addMeans(values, weighted_.data(), weight_.data(), width, out);
}

void NonLocalMeans::apply(const float* in, const float* noise_variance, float* out) {
  pad(in, values_);
  pad(noise_variance, precision_);
  invert(indexOf(0, size_.height + 2 * margin_px_) - kBlock, precision_.data() + kBlock);

  const int stride = settings_.stride_px;
  const int first = margin_px_ - settings_.window_radius * stride;
  for (std::size_t offset = 0; offset < offsets_.size(); ++offset) {
    for (int y = first - stride; y < first + stride; ++y) {
      addRow(offset, y);
    }
  }
  for (int y = first; y < margin_px_ + size_.height; ++y) {
    for (std::size_t offset = 0; offset < offsets_.size(); ++offset) {
      addRow(offset, y + stride);
      weighRow(offset, y);
    }
    if (y >= margin_px_) {
      averageRow(y, out + static_cast<std::size_t>(y - margin_px_) *
                              static_cast<std::size_t>(size_.width));
    }
  }
}

}  // namespace fast_edi
