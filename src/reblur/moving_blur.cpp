#include "reblur/moving_blur.hpp"

#include <algorithm>
#include <cstring>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

using Tap = SceneLayout::Tap;

/// One row of the image: the mean over the instants of the scene at their displacements.
FAST_EDI_VECTOR_CLONES
void gatherRow(const float* scene, std::size_t scene_stride, const Tap* tap, std::size_t blocks,
               std::size_t instants, float* out) {
  const float share = 1.0F / static_cast<float>(instants);
  for (std::size_t block = 0; block < blocks; ++block) {
    FloatBlock sum = {};
    for (std::size_t k = 0; k < instants; ++k, ++tap) {
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

/// Adds a row to one of the four corners of its taps. A pass for each corner, since a load that
/// overlaps a store just before it has to wait for it.
/// \param step from one block's tap to the next
FAST_EDI_VECTOR_CLONES
void scatterRow(const float* in, const Tap* tap, std::size_t step, std::size_t blocks, bool right,
                bool lower, float* scene) {
  for (std::size_t block = 0; block < blocks; ++block, tap += step) {
    const float weight = (right ? tap->x : 1.0F - tap->x) * (lower ? tap->y : 1.0F - tap->y);
    float* to = scene + tap->offset;
    FloatBlock sum;
    FloatBlock value;
    std::memcpy(&sum, to, sizeof(sum));
    std::memcpy(&value, in + block * kFloatBlock, sizeof(value));
    sum += weight * value;
    std::memcpy(to, &sum, sizeof(sum));
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
void scale(const float* __restrict in, std::size_t count, float by, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = by * in[i];
  }
}

}  // namespace

void MovingBlur::set(const ImageMotion& motion, const SceneLayout& layout, std::size_t instants) {
  constexpr double kHalf = 0.5;
  layout_ = layout;
  instants_ = instants;
  taps_.resize(layout.rows() * layout.blocks() * instants);
  double lost_x = 0.0;
  double lost_y = 0.0;
  for (std::size_t k = 0; k < instants; ++k) {
    const float tau = static_cast<float>(2 * k + 1) / static_cast<float>(instants) - 1.0F;
    const ImageMotion::Parts c = motion.at(tau);
    Tap* tap = taps_.data() + k;
    for (std::size_t y = 0; y < layout.rows(); ++y) {
      for (std::size_t block = 0; block < layout.blocks(); ++block, tap += instants) {
        *tap = layout.tap(block, y,
                          motion.displace(c, SceneLayout::centreOf(block), static_cast<float>(y)));
        lost_x += static_cast<double>(tap->x * (1.0F - tap->x));
        lost_y += static_cast<double>(tap->y * (1.0F - tap->y));
      }
    }
  }
  lost_x_ = static_cast<float>(kHalf * lost_x / static_cast<double>(taps_.size()));
  lost_y_ = static_cast<float>(kHalf * lost_y / static_cast<double>(taps_.size()));
  sharpened_.resize(layout.sceneFloats());
  scaled_.resize(layout.stride());
}

/// S, which is symmetric but for the first and last row: no tap reaches them.
void MovingBlur::sharpen(const float* in, float* out) const {
  const std::size_t stride = layout_.sceneStride();
  const std::size_t count = layout_.sceneFloats();
  std::copy(in, in + stride, out);
  std::copy(in + count - stride, in + count, out + count - stride);
  subtractNeighbours(in, count, stride, lost_x_, lost_y_, out);
}

void MovingBlur::apply(const float* scene, float* image) {
  sharpen(scene, sharpened_.data());
  const Tap* taps = taps_.data();
  for (std::size_t y = 0; y < layout_.rows(); ++y, taps += layout_.blocks() * instants_) {
    gatherRow(sharpened_.data(), layout_.sceneStride(), taps, layout_.blocks(), instants_,
              image + y * layout_.stride());
  }
}

void MovingBlur::applyTransposed(const float* image, float* scene) {
  const float share = 1.0F / static_cast<float>(instants_);
  const std::size_t below = layout_.sceneStride();
  float* sum = sharpened_.data();
  std::fill(sharpened_.begin(), sharpened_.end(), 0.0F);
  const Tap* taps = taps_.data();
  for (std::size_t y = 0; y < layout_.rows(); ++y, taps += layout_.blocks() * instants_) {
    scale(image + y * layout_.stride(), layout_.stride(), share, scaled_.data());
    for (std::size_t k = 0; k < instants_; ++k) {
      const auto add = [&](bool right, bool lower, float* to) {
        scatterRow(scaled_.data(), taps + k, instants_, layout_.blocks(), right, lower, to);
      };
      add(false, false, sum);
      add(true, false, sum + 1);
      add(false, true, sum + below);
      add(true, true, sum + below + 1);
    }
  }
  sharpen(sum, scene);
}

std::size_t MovingBlur::memoryBytes() const {
  return taps_.capacity() * sizeof(Tap) +
         (sharpened_.capacity() + scaled_.capacity()) * sizeof(float);
}

}  // namespace fast_edi
