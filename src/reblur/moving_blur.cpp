#include "reblur/moving_blur.hpp"

#include <algorithm>
#include <cstring>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

using Tap = SceneLayout::Tap;

using MaskBlock = std::int32_t __attribute__((vector_size(kFloatBlock * sizeof(std::int32_t))));

/// Taps of a group at one instant.
FAST_EDI_VECTOR_CLONES
void fillTaps(const ImageMotion& motion, const ImageMotion::Parts& c, const SceneLayout& layout,
              std::size_t group, Tap* taps) {
  const float y = SceneLayout::centreOfGroup(group);
  for (std::size_t block = 0; block < layout.blocks(); ++block) {
    taps[block] =
        layout.tap(block, group * kRowsAlike, motion.displace(c, SceneLayout::centreOf(block), y));
  }
}

/// Eight pixels, each between one and the next.
inline void between(const float* from, float x, FloatBlock& out) {
  FloatBlock next;
  std::memcpy(&out, from, sizeof(out));
  std::memcpy(&next, from + 1, sizeof(next));
  out += x * (next - out);
}

/// Rows of the image: the mean over the instants of the scene at their displacements.
FAST_EDI_VECTOR_CLONES
void gatherRows(const float* scene, std::size_t scene_stride, const Tap* taps, std::size_t blocks,
                std::size_t instants, float* out) {
  static_assert(kRowsAlike == 4, "the sums are written out: of an array they would go to memory");
  const float share = 1.0F / static_cast<float>(instants);
  const std::size_t stride = blocks * kFloatBlock;
  for (std::size_t block = 0; block < blocks; ++block, out += kFloatBlock) {
    FloatBlock first = {};
    FloatBlock second = {};
    FloatBlock third = {};
    FloatBlock fourth = {};
    const Tap* tap = taps + block;
    for (std::size_t k = 0; k < instants; ++k, tap += blocks) {
      const float* from = scene + tap->offset;
      FloatBlock above;
      FloatBlock below;
      between(from, tap->x, above);
      between(from + scene_stride, tap->x, below);
      first += above + tap->y * (below - above);
      between(from + 2 * scene_stride, tap->x, above);
      second += below + tap->y * (above - below);
      between(from + 3 * scene_stride, tap->x, below);
      third += above + tap->y * (below - above);
      between(from + 4 * scene_stride, tap->x, above);
      fourth += below + tap->y * (above - below);
    }
    first *= share;
    second *= share;
    third *= share;
    fourth *= share;
    std::memcpy(out, &first, sizeof(first));
    std::memcpy(out + stride, &second, sizeof(second));
    std::memcpy(out + 2 * stride, &third, sizeof(third));
    std::memcpy(out + 3 * stride, &fourth, sizeof(fourth));
  }
}

/// What blocks add to the eight pixels from their tap on, in the rows of the tap and in that below.
/// \param in rows of whole blocks; the value in front of them is not used
FAST_EDI_VECTOR_CLONES
void scatterBlocks(const float* __restrict in, const Tap* taps, std::size_t blocks,
                   std::size_t scene_stride, float* __restrict scene) {
  const MaskBlock behind_first = {0, -1, -1, -1, -1, -1, -1, -1};
  for (std::size_t block = 0; block < blocks; ++block) {
    float* to = scene + taps[block].offset;
    FloatBlock below = {};
    for (std::size_t i = 0; i <= kRowsAlike; ++i, to += scene_stride) {
      FloatBlock sum;
      std::memcpy(&sum, to, sizeof(sum));
      sum += below;
      if (i < kRowsAlike) {
        const float* from = in + (i * blocks + block) * kFloatBlock;
        FloatBlock value;
        MaskBlock bits;
        FloatBlock before;
        std::memcpy(&value, from, sizeof(value));
        std::memcpy(&bits, from - 1, sizeof(bits));
        bits &= behind_first;
        std::memcpy(&before, &bits, sizeof(before));
        value += taps[block].x * (before - value);
        below = taps[block].y * value;
        sum += value - below;
      }
      std::memcpy(to, &sum, sizeof(sum));
    }
  }
}

/// What they add to the ninth. Apart, since a load that overlaps a smaller store just before it has
/// to wait for it.
void scatterLast(const float* in, const Tap* taps, std::size_t blocks, std::size_t scene_stride,
                 float* scene) {
  for (std::size_t block = 0; block < blocks; ++block) {
    float* to = scene + taps[block].offset + kFloatBlock;
    float below = 0.0F;
    for (std::size_t i = 0; i < kRowsAlike; ++i, to += scene_stride) {
      const float value = taps[block].x * in[(i * blocks + block + 1) * kFloatBlock - 1];
      const float next = taps[block].y * value;
      *to += below + (value - next);
      below = next;
    }
    *to += below;
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
  taps_.resize(layout.groups() * instants * layout.blocks());
  Tap* taps = taps_.data();
  for (std::size_t group = 0; group < layout.groups(); ++group) {
    for (std::size_t k = 0; k < instants; ++k, taps += layout.blocks()) {
      const float tau = static_cast<float>(2 * k + 1) / static_cast<float>(instants) - 1.0F;
      fillTaps(motion, motion.at(tau), layout, group, taps);
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
  rows_.assign(kFloatBlock + kRowsAlike * layout.stride(), 0.0F);
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

/// To rows_.
void MovingBlur::gather(std::size_t group) {
  gatherRows(sharpened_.data(), layout_.sceneStride(), tapsOf(group), layout_.blocks(), instants_,
             rows_.data() + kFloatBlock);
}

/// Adds rows_ to sum_.
void MovingBlur::scatter(std::size_t group) {
  scale(rows_.size(), 1.0F / static_cast<float>(instants_), rows_.data());
  const float* rows = rows_.data() + kFloatBlock;
  const Tap* taps = tapsOf(group);
  for (std::size_t k = 0; k < instants_; ++k, taps += layout_.blocks()) {
    scatterBlocks(rows, taps, layout_.blocks(), layout_.sceneStride(), sum_.data());
    scatterLast(rows, taps, layout_.blocks(), layout_.sceneStride(), sum_.data());
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
  for (std::size_t group = 0; group < layout_.groups(); ++group) {
    forRows(group, [&](std::size_t row, float* values) {
      std::copy_n(image + row * layout_.stride(), layout_.stride(), values);
    });
    scatter(group);
  }
  for (std::size_t row = 0; row < layout_.sceneRows(); ++row) {
    sharpenRow(sum_.data(), row, scene);
  }
}

std::size_t MovingBlur::memoryBytes() const {
  return taps_.capacity() * sizeof(Tap) +
         (sharpened_.capacity() + sum_.capacity() + rows_.capacity()) * sizeof(float);
}

}  // namespace fast_edi
