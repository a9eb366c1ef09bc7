#include "reblur/moving_blur.hpp"

#include <algorithm>
#include <cstring>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

using Tap = SceneLayout::Tap;

/// Taps of rows alike at one instant.
FAST_EDI_VECTOR_CLONES
void fillTaps(const ImageMotion& motion, const ImageMotion::Parts& c, const SceneLayout& layout,
              std::size_t row, Tap* taps) {
  const float y = SceneLayout::centreOfRows(row);
  for (std::size_t block = 0; block < layout.blocks(); ++block) {
    taps[block] = layout.tap(block, row, motion.displace(c, SceneLayout::centreOf(block), y));
  }
}

/// One row of the image: the mean over the instants of the scene at their displacements.
FAST_EDI_VECTOR_CLONES
void gatherRow(const float* scene, std::size_t scene_stride, const Tap* taps, std::size_t blocks,
               std::size_t instants, float* out) {
  const float share = 1.0F / static_cast<float>(instants);
  for (std::size_t block = 0; block < blocks; ++block) {
    FloatBlock sum = {};
    const Tap* tap = taps + block;
    for (std::size_t k = 0; k < instants; ++k, tap += blocks) {
      const float* upper = scene + tap->offset;
      const float* lower = upper + scene_stride;
      FloatBlock a;
      FloatBlock b;
      FloatBlock c;
      FloatBlock d;
      std::memcpy(&a, upper, sizeof(a));
      std::memcpy(&b, upper + 1, sizeof(b));
      std::memcpy(&c, lower, sizeof(c));
      std::memcpy(&d, lower + 1, sizeof(d));
      const FloatBlock top = a + tap->x * (b - a);
      const FloatBlock bottom = c + tap->x * (d - c);
      sum += top + tap->y * (bottom - top);
    }
    sum *= share;
    std::memcpy(out + block * kFloatBlock, &sum, sizeof(sum));
  }
}

/// What a block adds to the eight pixels from its tap on, in the row of the tap and in that below.
/// \param shifted \p in by one pixel within each block, 0 in front
FAST_EDI_VECTOR_CLONES
void scatterBlocks(const float* __restrict in, const float* __restrict shifted, const Tap* taps,
                   std::size_t blocks, std::size_t scene_stride, float* __restrict scene) {
  for (std::size_t block = 0; block < blocks; ++block) {
    float* upper = scene + taps[block].offset;
    float* lower = upper + scene_stride;
    FloatBlock value;
    FloatBlock before;
    FloatBlock sum;
    std::memcpy(&value, in + block * kFloatBlock, sizeof(value));
    std::memcpy(&before, shifted + block * kFloatBlock, sizeof(before));
    value += taps[block].x * (before - value);
    before = taps[block].y * value;
    value -= before;
    std::memcpy(&sum, upper, sizeof(sum));
    sum += value;
    std::memcpy(upper, &sum, sizeof(sum));
    std::memcpy(&sum, lower, sizeof(sum));
    sum += before;
    std::memcpy(lower, &sum, sizeof(sum));
  }
}

/// What they add to the ninth. Apart, since a load that overlaps a smaller store just before it has
/// to wait for it.
void scatterLast(const float* in, const Tap* taps, std::size_t blocks, std::size_t scene_stride,
                 float* scene) {
  for (std::size_t block = 0; block < blocks; ++block) {
    float* upper = scene + taps[block].offset + kFloatBlock;
    const float value = taps[block].x * in[block * kFloatBlock + kFloatBlock - 1];
    const float below = taps[block].y * value;
    *upper += value - below;
    upper[scene_stride] += below;
  }
}

/// Takes away a part of each pixel's neighbours.
FAST_EDI_VECTOR_CLONES
void subtractNeighbours(const float* __restrict in, std::size_t count, std::size_t stride, float x,
                        float y, float* __restrict out) {
  const float centre = 1.0F + 2.0F * (x + y);
  const float* __restrict left = in - 1;
  const float* __restrict above = in - stride;
  const float* __restrict below = in + stride;
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = centre * in[i] - x * (left[i] + in[i + 1]) - y * (above[i] + below[i]);
  }
}

FAST_EDI_VECTOR_CLONES
void scale(std::size_t count, float by, float* values) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] *= by;
  }
}

}  // namespace

void MovingBlur::set(const ImageMotion& motion, const SceneLayout& layout, std::size_t instants) {
  constexpr double kHalf = 0.5;
  layout_ = layout;
  instants_ = instants;
  const std::size_t groups = (layout.rows() + kRowsAlike - 1) / kRowsAlike;
  taps_.resize(groups * instants * layout.blocks());
  Tap* taps = taps_.data();
  for (std::size_t row = 0; row < layout.rows(); row += kRowsAlike) {
    for (std::size_t k = 0; k < instants; ++k, taps += layout.blocks()) {
      const float tau = static_cast<float>(2 * k + 1) / static_cast<float>(instants) - 1.0F;
      fillTaps(motion, motion.at(tau), layout, row, taps);
    }
  }
  double lost_x = 0.0;
  double lost_y = 0.0;
  for (const Tap& tap : taps_) {
    lost_x += static_cast<double>(tap.x * (1.0F - tap.x));
    lost_y += static_cast<double>(tap.y * (1.0F - tap.y));
  }
  lost_x_ = static_cast<float>(kHalf * lost_x / static_cast<double>(taps_.size()));
  lost_y_ = static_cast<float>(kHalf * lost_y / static_cast<double>(taps_.size()));
  sharpened_.resize(layout.sceneFloats());
  sum_.resize(layout.sceneFloats());
  row_.resize(layout.stride());
  shifted_.assign(layout.stride(), 0.0F);
}

/// A row of S, which is symmetric but for the first and last row: no tap reaches them.
void MovingBlur::sharpenRow(const float* in, std::size_t row, float* out) const {
  const std::size_t stride = layout_.sceneStride();
  const std::size_t first = row * stride;
  if (row == 0 || row + 1 == layout_.sceneRows()) {
    std::copy_n(in + first, stride, out + first);
  } else {
    subtractNeighbours(in + first, stride, stride, lost_x_, lost_y_, out + first);
  }
}

/// Sharpens what the row that was just prepared completes. \return how many rows are sharp
std::size_t MovingBlur::sharpenBehind(const float* scene, std::size_t prepared) {
  if (prepared > 0) {
    sharpenRow(scene, prepared - 1, sharpened_.data());
  }
  if (prepared + 1 < layout_.sceneRows()) {
    return prepared;
  }
  sharpenRow(scene, prepared, sharpened_.data());
  return prepared + 1;
}

void MovingBlur::clearSum(std::size_t row) {
  std::fill_n(sum_.data() + row * layout_.sceneStride(), layout_.sceneStride(), 0.0F);
}

/// To row_.
void MovingBlur::gather(std::size_t row) {
  gatherRow(sharpened_.data() + fromFirst(row), layout_.sceneStride(), tapsOf(row),
            layout_.blocks(), instants_, row_.data());
}

/// Adds row_ to sum_.
void MovingBlur::scatter(std::size_t row) {
  scale(row_.size(), 1.0F / static_cast<float>(instants_), row_.data());
  std::copy(row_.begin(), row_.end() - 1, shifted_.begin() + 1);
  for (std::size_t i = 0; i < shifted_.size(); i += kFloatBlock) {
    shifted_[i] = 0.0F;
  }
  float* sum = sum_.data() + fromFirst(row);
  const Tap* taps = tapsOf(row);
  for (std::size_t k = 0; k < instants_; ++k, taps += layout_.blocks()) {
    scatterBlocks(row_.data(), shifted_.data(), taps, layout_.blocks(), layout_.sceneStride(), sum);
    scatterLast(row_.data(), taps, layout_.blocks(), layout_.sceneStride(), sum);
  }
}

void MovingBlur::apply(const float* scene, float* image) {
  const std::size_t stride = layout_.stride();
  applyRows(
      scene, [](std::size_t) {},
      [&](std::size_t row, const float* values) {
        std::copy_n(values, stride, image + row * stride);
      });
}

void MovingBlur::applyTransposed(const float* image, float* scene) {
  std::fill(sum_.begin(), sum_.end(), 0.0F);
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    std::copy_n(image + row * layout_.stride(), layout_.stride(), row_.data());
    scatter(row);
  }
  for (std::size_t row = 0; row < layout_.sceneRows(); ++row) {
    sharpenRow(sum_.data(), row, scene);
  }
}

std::size_t MovingBlur::memoryBytes() const {
  return taps_.capacity() * sizeof(Tap) +
         (sharpened_.capacity() + sum_.capacity() + row_.capacity() + shifted_.capacity()) *
             sizeof(float);
}

}  // namespace fast_edi
