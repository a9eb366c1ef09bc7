#include "reblur/moving_blur.hpp"

#include <algorithm>
#include <cstring>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

using Tap = SceneLayout::Tap;

/// Taps of one row at one instant.
FAST_EDI_VECTOR_CLONES
void fillTaps(const ImageMotion& motion, const ImageMotion::Parts& c, const SceneLayout& layout,
              std::size_t row, Tap* taps) {
  const auto y = static_cast<float>(row);
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

FAST_EDI_VECTOR_CLONES
void multiply(const float* __restrict by, std::size_t count, float* __restrict values) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] *= by[i];
  }
}

/// Takes away a part of each pixel's neighbours; not in the first and last row.
FAST_EDI_VECTOR_CLONES
void subtractNeighbours(const float* __restrict in, std::size_t count, std::size_t stride, float x,
                        float y, float* __restrict out) {
  const float centre = 1.0F + 2.0F * (x + y);
  for (std::size_t i = stride; i < count - stride; ++i) {
    out[i] = centre * in[i] - x * (in[i - 1] + in[i + 1]) - y * (in[i - stride] + in[i + stride]);
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
  constexpr std::size_t kRowsApart = 4;  // of those that the lost part is measured in
  layout_ = layout;
  instants_ = instants;
  taps_.resize(layout.rows() * instants * layout.blocks());
  double lost_x = 0.0;
  double lost_y = 0.0;
  std::size_t looked_at = 0;
  for (std::size_t k = 0; k < instants; ++k) {
    const float tau = static_cast<float>(2 * k + 1) / static_cast<float>(instants) - 1.0F;
    const ImageMotion::Parts c = motion.at(tau);
    for (std::size_t y = 0; y < layout.rows(); ++y) {
      Tap* taps = taps_.data() + tapsBefore(y) + k * layout.blocks();
      fillTaps(motion, c, layout, y, taps);
      if (y % kRowsApart != 0) {
        continue;
      }
      for (const Tap* tap = taps; tap < taps + layout.blocks(); ++tap, ++looked_at) {
        lost_x += static_cast<double>(tap->x * (1.0F - tap->x));
        lost_y += static_cast<double>(tap->y * (1.0F - tap->y));
      }
    }
  }
  lost_x_ = static_cast<float>(kHalf * lost_x / static_cast<double>(looked_at));
  lost_y_ = static_cast<float>(kHalf * lost_y / static_cast<double>(looked_at));
  sharpened_.resize(layout.sceneFloats());
  sum_.resize(layout.sceneFloats());
  row_.resize(layout.stride());
  shifted_.assign(layout.stride(), 0.0F);
}

/// S, which is symmetric but for the first and last row: no tap reaches them.
void MovingBlur::sharpen(const float* in, float* out) const {
  const std::size_t stride = layout_.sceneStride();
  const std::size_t count = layout_.sceneFloats();
  std::copy(in, in + stride, out);
  std::copy(in + count - stride, in + count, out + count - stride);
  subtractNeighbours(in, count, stride, lost_x_, lost_y_, out);
}

void MovingBlur::gather(std::size_t row, float* out) const {
  gatherRow(sharpened_.data(), layout_.sceneStride(), taps_.data() + tapsBefore(row),
            layout_.blocks(), instants_, out);
}

/// Adds row_ to sum_.
void MovingBlur::scatter(std::size_t row) {
  scale(row_.size(), 1.0F / static_cast<float>(instants_), row_.data());
  std::copy(row_.begin(), row_.end() - 1, shifted_.begin() + 1);
  for (std::size_t i = 0; i < shifted_.size(); i += kFloatBlock) {
    shifted_[i] = 0.0F;
  }
  const Tap* taps = taps_.data() + tapsBefore(row);
  for (std::size_t k = 0; k < instants_; ++k, taps += layout_.blocks()) {
    scatterBlocks(row_.data(), shifted_.data(), taps, layout_.blocks(), layout_.sceneStride(),
                  sum_.data());
    scatterLast(row_.data(), taps, layout_.blocks(), layout_.sceneStride(), sum_.data());
  }
}

void MovingBlur::apply(const float* scene, float* image) {
  sharpen(scene, sharpened_.data());
  for (std::size_t y = 0; y < layout_.rows(); ++y) {
    gather(y, image + y * layout_.stride());
  }
}

void MovingBlur::applyTransposed(const float* image, float* scene) {
  std::fill(sum_.begin(), sum_.end(), 0.0F);
  for (std::size_t y = 0; y < layout_.rows(); ++y) {
    std::copy_n(image + y * layout_.stride(), layout_.stride(), row_.data());
    scatter(y);
  }
  sharpen(sum_.data(), scene);
}

void MovingBlur::applyNormal(const float* scene, const float* weights, float* out) {
  sharpen(scene, sharpened_.data());
  std::fill(sum_.begin(), sum_.end(), 0.0F);
  for (std::size_t y = 0; y < layout_.rows(); ++y) {
    gather(y, row_.data());
    multiply(weights + y * layout_.stride(), row_.size(), row_.data());
    scatter(y);
  }
  sharpen(sum_.data(), out);
}

std::size_t MovingBlur::memoryBytes() const {
  return taps_.capacity() * sizeof(Tap) +
         (sharpened_.capacity() + sum_.capacity() + row_.capacity() + shifted_.capacity()) *
             sizeof(float);
}

}  // namespace fast_edi
