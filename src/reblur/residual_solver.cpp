#include "reblur/residual_solver.hpp"

#include <algorithm>
#include <cstring>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

constexpr int kSteps = 4;
/// From here on a level is cut off [8-bit DN].
constexpr float kSaturated_dn = 254.0F;
constexpr float kLeastNoise_dn = 1.0F;
constexpr float kRobust = 6.0F;  ///< in standard deviations
constexpr float kFree_dn = 2.0F;
constexpr float kFreeWithEvents = 0.1F;
constexpr float kSmoothness = 0.2F;  ///< [1/DN^2]
constexpr float kEdge_dn = 3.0F;

FAST_EDI_VECTOR_CLONES
void anchors(const float* __restrict level, const float* __restrict count, std::size_t pixels,
             float offset, float* __restrict anchor) {
  for (std::size_t i = 0; i < pixels; ++i) {
    const float spread =
        kFree_dn + kFreeWithEvents * std::min(1.0F, count[i]) * (level[i] + offset);
    anchor[i] = 1.0F / (spread * spread);
  }
}

FAST_EDI_VECTOR_CLONES
void likeness(const float* __restrict a, const float* __restrict b, std::size_t count,
              float* __restrict weight) {
  constexpr float kPrecision = 1.0F / (kEdge_dn * kEdge_dn);
  for (std::size_t i = 0; i < count; ++i) {
    const float d = a[i] - b[i];
    weight[i] = kSmoothness / (1.0F + kPrecision * d * d);
  }
}

FAST_EDI_VECTOR_CLONES
void residuals(const float* __restrict blurry, const float* __restrict reblurred, std::size_t count,
               float* __restrict residual) {
  for (std::size_t i = 0; i < count; ++i) {
    residual[i] = blurry[i] >= kSaturated_dn ? 0.0F : blurry[i] - reblurred[i];
  }
}

FAST_EDI_VECTOR_CLONES
void precisions(const float* __restrict residual, std::size_t count, float noise,
                float* __restrict precision) {
  const float variance = noise * noise;
  const float robust = 1.0F / (kRobust * kRobust * variance);
  for (std::size_t i = 0; i < count; ++i) {
    precision[i] = 1.0F / (variance * (1.0F + robust * residual[i] * residual[i]));
  }
}

FAST_EDI_VECTOR_CLONES
void multiply(const float* __restrict by, std::size_t count, float* __restrict values) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] *= by[i];
  }
}

float total(const FloatBlock& sum) {
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/// Sum of products over a row of whole blocks.
FAST_EDI_VECTOR_CLONES
float dotOfRow(const float* x, const float* y, std::size_t count) {
  FloatBlock sum = {};
  for (std::size_t i = 0; i < count; i += kFloatBlock) {
    FloatBlock a;
    FloatBlock b;
    std::memcpy(&a, x + i, sizeof(a));
    std::memcpy(&b, y + i, sizeof(b));
    sum += a * b;
  }
  return total(sum);
}

/// A step of a row: \p solution and \p gradient. \return sum of squares of the new gradient
FAST_EDI_VECTOR_CLONES
float stepRow(std::size_t count, float length, const float* direction, const float* product,
              float* solution, float* gradient) {
  FloatBlock sum = {};
  for (std::size_t i = 0; i < count; i += kFloatBlock) {
    FloatBlock way;
    FloatBlock value;
    std::memcpy(&way, direction + i, sizeof(way));
    std::memcpy(&value, solution + i, sizeof(value));
    value += length * way;
    std::memcpy(solution + i, &value, sizeof(value));
    std::memcpy(&way, product + i, sizeof(way));
    std::memcpy(&value, gradient + i, sizeof(value));
    value -= length * way;
    std::memcpy(gradient + i, &value, sizeof(value));
    sum += value * value;
  }
  return total(sum);
}

FAST_EDI_VECTOR_CLONES
void scaleAndAdd(std::size_t count, float factor, const float* __restrict x, float* __restrict y) {
  for (std::size_t i = 0; i < count; ++i) {
    y[i] = x[i] + factor * y[i];
  }
}

/// Precisions of the prior, at the first pixel of a row.
struct Prior {
  const float* anchor;
  const float* across;
  const float* down;
};

/// Adds what anchor and likeness of neighbours contribute to the product.
FAST_EDI_VECTOR_CLONES
void addPrior(const Prior& prior, const float* __restrict in, std::size_t count, std::size_t stride,
              float* __restrict out) {
  const float* __restrict anchor = prior.anchor;
  const float* __restrict across = prior.across;
  const float* __restrict down = prior.down;
  const float* __restrict down_above = prior.down - stride;
  const float* __restrict above = in - stride;
  const float* __restrict below = in + stride;
  for (std::size_t i = 0; i < count; ++i) {
    const float value = in[i];
    out[i] += anchor[i] * value +
              (across[i] * (value - in[i + 1]) + *(across + i - 1) * (value - *(in + i - 1))) +
              (down[i] * (value - below[i]) + down_above[i] * (value - above[i]));
  }
}

/// Copies a plane of the image into one of the scene; beyond the border its nearest pixel counts.
void extend(const float* plane, const SceneLayout& layout, std::vector<float>& scene) {
  const auto width = static_cast<std::size_t>(layout.size().width);
  const std::size_t stride = layout.sceneStride();
  const std::size_t margin = layout.margin();
  scene.resize(layout.sceneFloats());
  for (std::size_t y = 0; y < layout.sceneRows(); ++y) {
    const std::size_t inside = std::clamp(y, margin, margin + layout.rows() - 1) - margin;
    const float* from = plane + inside * width;
    float* to = scene.data() + y * stride;
    std::fill(to, to + margin, from[0]);
    std::copy(from, from + width, to + margin);
    std::fill(to + margin + width, to + stride, from[width - 1]);
  }
}

}  // namespace

void ResidualSolver::load(const Input& input, const SceneLayout& layout) {
  const std::size_t count = layout.sceneFloats();
  const std::size_t stride = layout.sceneStride();
  extend(input.mean_counts, layout, product_);
  extend(input.latent_dn, layout, given_);
  anchor_.resize(count);
  across_.resize(count);
  down_.resize(count);
  anchors(given_.data(), product_.data(), count, input.offset_dn, anchor_.data());
  likeness(given_.data(), given_.data() + 1, count - 1, across_.data());
  likeness(given_.data(), given_.data() + stride, count - stride, down_.data());
  for (std::size_t end = stride; end <= count; end += stride) {
    across_[end - 1] = 0.0F;
  }
  for (std::vector<float>* image : {&precision_, &before_, &after_, &image_}) {
    image->assign(layout.imageFloats(), 0.0F);
  }
  direction_.resize(count);
  gradient_.resize(count);
  product_.resize(count);
}

void ResidualSolver::measureResidual(const Input& input, MovingBlur& blur,
                                     const std::vector<float>& scene,
                                     std::vector<float>& residual) {
  const SceneLayout& layout = blur.layout();
  const auto width = static_cast<std::size_t>(layout.size().width);
  blur.apply(scene.data(), image_.data());
  for (std::size_t y = 0; y < layout.rows(); ++y) {
    residuals(input.blurry_dn + y * width, image_.data() + y * layout.stride(), width,
              residual.data() + y * layout.stride());
  }
}

/// Applies the normal equations to the direction. \return its product with the result
double ResidualSolver::applyEquations(MovingBlur& blur) {
  const std::size_t count = blur.layout().sceneFloats();
  const std::size_t stride = blur.layout().sceneStride();
  blur.applyNormal(direction_.data(), precision_.data(), product_.data());
  double energy = 0.0;
  for (std::size_t i = 0; i < count; i += stride) {
    if (i > 0 && i + stride < count) {
      addPrior({anchor_.data() + i, across_.data() + i, down_.data() + i}, direction_.data() + i,
               stride, stride, product_.data() + i);
    }
    energy += static_cast<double>(dotOfRow(direction_.data() + i, product_.data() + i, stride));
  }
  return energy;
}

void ResidualSolver::iterate(MovingBlur& blur) {
  const std::size_t count = blur.layout().sceneFloats();
  const std::size_t stride = blur.layout().sceneStride();
  std::copy(before_.begin(), before_.end(), image_.begin());
  multiply(precision_.data(), image_.size(), image_.data());
  blur.applyTransposed(image_.data(), gradient_.data());
  direction_ = gradient_;
  double squares = 0.0;
  for (std::size_t i = 0; i < count; i += stride) {
    squares += static_cast<double>(dotOfRow(gradient_.data() + i, gradient_.data() + i, stride));
  }
  for (int step = 0; step < kSteps; ++step) {
    const double energy = applyEquations(blur);
    if (energy <= 0.0) {
      return;  // no residual
    }
    const auto length = static_cast<float>(squares / energy);
    double next = 0.0;
    for (std::size_t i = 0; i < count; i += stride) {
      next +=
          static_cast<double>(stepRow(stride, length, direction_.data() + i, product_.data() + i,
                                      solution_.data() + i, gradient_.data() + i));
    }
    if (step + 1 < kSteps) {
      scaleAndAdd(count, static_cast<float>(next / squares), gradient_.data(), direction_.data());
    }
    squares = next;
  }
}

void ResidualSolver::solve(const Input& input, MovingBlur& blur) {
  load(input, blur.layout());
  solution_ = given_;
  measureResidual(input, blur, given_, before_);
  const SceneLayout& layout = blur.layout();
  const auto width = static_cast<std::size_t>(layout.size().width);
  const float noise = std::max(input.noise_dn, kLeastNoise_dn);
  for (std::size_t y = 0; y < layout.rows(); ++y) {
    // Beyond the image's width it stays 0, and where the frame is saturated the residual is.
    precisions(before_.data() + y * layout.stride(), width, noise,
               precision_.data() + y * layout.stride());
    for (std::size_t x = 0; x < width; ++x) {
      if (input.blurry_dn[y * width + x] >= kSaturated_dn) {
        precision_[y * layout.stride() + x] = 0.0F;
      }
    }
  }
  iterate(blur);
  measureResidual(input, blur, solution_, after_);
}

std::size_t ResidualSolver::memoryBytes() const {
  std::size_t floats = 0;
  for (const std::vector<float>* plane :
       {&given_, &solution_, &anchor_, &across_, &down_, &precision_, &before_, &after_, &image_,
        &direction_, &gradient_, &product_}) {
    floats += plane->capacity();
  }
  return floats * sizeof(float);
}

}  // namespace fast_edi
