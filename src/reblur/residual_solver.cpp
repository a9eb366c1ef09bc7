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

/// Of a row of whole blocks.
FAST_EDI_VECTOR_CLONES
void anchors(const float* level, const float* count, std::size_t pixels, float offset,
             float* anchor) {
  for (std::size_t i = 0; i < pixels; i += kFloatBlock) {
    FloatBlock spread;
    FloatBlock events;
    std::memcpy(&spread, level + i, sizeof(spread));
    std::memcpy(&events, count + i, sizeof(events));
    events = events < 1.0F ? events : events - events + 1.0F;
    spread = kFree_dn + kFreeWithEvents * events * (spread + offset);
    spread = 1.0F / (spread * spread);
    std::memcpy(anchor + i, &spread, sizeof(spread));
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
    const float seen = blurry[i] < kSaturated_dn ? 1.0F : 0.0F;
    residual[i] = seen * (blurry[i] - reblurred[i]);
  }
}

/// Where the frame is saturated they are 0.
FAST_EDI_VECTOR_CLONES
void precisions(const float* __restrict blurry, const float* __restrict residual, std::size_t count,
                float noise, float* __restrict precision) {
  const float variance = noise * noise;
  const float robust = 1.0F / (kRobust * kRobust * variance);
  for (std::size_t i = 0; i < count; ++i) {
    const float seen = blurry[i] < kSaturated_dn ? 1.0F : 0.0F;
    precision[i] = seen / (variance * (1.0F + robust * residual[i] * residual[i]));
  }
}

float total(const FloatBlock& sum) {
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/// Sum of squares over a row of whole blocks.
FAST_EDI_VECTOR_CLONES
float squaresOfRow(const float* values, std::size_t count) {
  FloatBlock sum = {};
  for (std::size_t i = 0; i < count; i += kFloatBlock) {
    FloatBlock value;
    std::memcpy(&value, values + i, sizeof(value));
    sum += value * value;
  }
  return total(sum);
}

/// Weighs a row. \return sum of its weighted squares
FAST_EDI_VECTOR_CLONES
float weigh(const float* weights, std::size_t count, float* values) {
  FloatBlock sum = {};
  for (std::size_t i = 0; i < count; i += kFloatBlock) {
    FloatBlock weight;
    FloatBlock value;
    std::memcpy(&weight, weights + i, sizeof(weight));
    std::memcpy(&value, values + i, sizeof(value));
    weight *= value;
    std::memcpy(values + i, &weight, sizeof(weight));
    sum += weight * value;
  }
  return total(sum);
}

FAST_EDI_VECTOR_CLONES
void addScaled(const float* __restrict x, std::size_t count, float factor, float* __restrict y) {
  for (std::size_t i = 0; i < count; ++i) {
    y[i] += factor * x[i];
  }
}

/// A row of each plane of the conjugate gradients.
struct GradientRows {
  const float* product;
  float* direction;
  float* gradient;
  float* solution;
};
FAST_EDI_VECTOR_CLONES
void advance(const GradientRows& rows, std::size_t count, float length, float factor) {
  const float* __restrict product = rows.product;
  float* __restrict direction = rows.direction;
  float* __restrict gradient = rows.gradient;
  float* __restrict solution = rows.solution;
  for (std::size_t i = 0; i < count; ++i) {
    const float way = direction[i];
    const float left = gradient[i] - length * product[i];
    solution[i] += length * way;
    gradient[i] = left;
    direction[i] = left + factor * way;
  }
}

/// Precisions of the prior, at the first pixel of a row.
struct Prior {
  const float* anchor;
  const float* across;
  const float* down;
};

struct Sums {
  float energy;   ///< of the direction with the product
  float squares;  ///< of the product
};

/// Adds what anchor and likeness of neighbours contribute to the product, a row of whole blocks.
FAST_EDI_VECTOR_CLONES
Sums addPrior(const Prior& prior, const float* direction, std::size_t count, std::size_t stride,
              float* product) {
  FloatBlock energy = {};
  FloatBlock squares = {};
  for (std::size_t i = 0; i < count; i += kFloatBlock) {
    const float* at = direction + i;
    FloatBlock value;
    FloatBlock neighbour;
    FloatBlock weight;
    FloatBlock sum;
    std::memcpy(&value, at, sizeof(value));
    std::memcpy(&weight, prior.anchor + i, sizeof(weight));
    std::memcpy(&sum, product + i, sizeof(sum));
    sum += weight * value;
    std::memcpy(&weight, prior.across + i, sizeof(weight));
    std::memcpy(&neighbour, at + 1, sizeof(neighbour));
    sum += weight * (value - neighbour);
    std::memcpy(&weight, prior.across + i - 1, sizeof(weight));
    std::memcpy(&neighbour, at - 1, sizeof(neighbour));
    sum += weight * (value - neighbour);
    std::memcpy(&weight, prior.down + i, sizeof(weight));
    std::memcpy(&neighbour, at + stride, sizeof(neighbour));
    sum += weight * (value - neighbour);
    std::memcpy(&weight, prior.down + i - stride, sizeof(weight));
    std::memcpy(&neighbour, at - stride, sizeof(neighbour));
    sum += weight * (value - neighbour);
    std::memcpy(product + i, &sum, sizeof(sum));
    energy += value * sum;
    squares += sum * sum;
  }
  return {total(energy), total(squares)};
}

/// Copies a row of the image into one of the scene; beyond the border its nearest pixel counts.
void extendRow(const float* from, const SceneLayout& layout, float* to) {
  const auto width = static_cast<std::size_t>(layout.size().width);
  std::fill(to, to + layout.margin(), from[0]);
  std::copy(from, from + width, to + layout.margin());
  std::fill(to + layout.margin() + width, to + layout.sceneStride(), from[width - 1]);
}

}  // namespace

void ResidualSolver::resize(const SceneLayout& layout) {
  for (std::vector<float>* scene :
       {&given_, &solution_, &anchor_, &across_, &down_, &direction_, &gradient_, &product_}) {
    scene->resize(layout.sceneFloats());
  }
  for (std::vector<float>* image : {&precision_, &before_, &after_}) {
    image->resize(layout.imageFloats());
  }
}

/// Given levels, anchors and likenesses of a row of the scene.
void ResidualSolver::loadRow(const Input& input, const SceneLayout& layout, std::size_t row) {
  const std::size_t margin = layout.margin();
  const std::size_t inside = std::clamp(row, margin, margin + layout.rows() - 1) - margin;
  const std::size_t pixel = inside * static_cast<std::size_t>(layout.size().width);
  const std::size_t stride = layout.sceneStride();
  const std::size_t first = row * stride;
  float* given = given_.data() + first;
  float* counts = product_.data() + first;  // scratch as yet
  extendRow(input.latent_dn + pixel, layout, given);
  extendRow(input.mean_counts + pixel, layout, counts);
  std::copy_n(given, stride, solution_.data() + first);
  anchors(given, counts, stride, input.offset_dn, anchor_.data() + first);
  likeness(given, given + 1, stride - 1, across_.data() + first);
  across_[first + stride - 1] = 0.0F;
  if (row > 0) {
    likeness(given - stride, given, stride, down_.data() + first - stride);
  }
}

/// Residual and precision of a row of the image. \param values of A L0; written: their product
void ResidualSolver::weighRow(const Input& input, const SceneLayout& layout, std::size_t row,
                              float* values) {
  const auto width = static_cast<std::size_t>(layout.size().width);
  const std::size_t stride = layout.stride();
  const float* blurry = input.blurry_dn + row * width;
  float* before = before_.data() + row * stride;
  float* precision = precision_.data() + row * stride;
  residuals(blurry, values, width, before);
  precisions(blurry, before, width, std::max(input.noise_dn, kLeastNoise_dn), precision);
  std::fill(before + width, before + stride, 0.0F);
  std::fill(precision + width, precision + stride, 0.0F);
  std::copy_n(before, stride, values);
  weigh(precision, stride, values);
}

/// The gradient at L0, which is the first direction. \return its sum of squares
double ResidualSolver::start(const Input& input, MovingBlur& blur) {
  const SceneLayout& layout = blur.layout();
  const std::size_t stride = layout.sceneStride();
  double squares = 0.0;
  blur.applyNormalRows(
      given_.data(), gradient_.data(), [&](std::size_t row) { loadRow(input, layout, row); },
      [&](std::size_t row, float* values) { weighRow(input, layout, row, values); },
      [&](std::size_t row) {
        const float* gradient = gradient_.data() + row * stride;
        std::copy_n(gradient, stride, direction_.data() + row * stride);
        squares += static_cast<double>(squaresOfRow(gradient, stride));
      });
  return squares;
}

void ResidualSolver::advanceRow(const SceneLayout& layout, std::size_t row, const Step& step) {
  const std::size_t first = row * layout.sceneStride();
  advance({product_.data() + first, direction_.data() + first, gradient_.data() + first,
           solution_.data() + first},
          layout.sceneStride(), step.length, step.factor);
}

/// Completes a row of the product. \return the direction's product with it
double ResidualSolver::addPriorOfRow(const SceneLayout& layout, std::size_t row, double* squares) {
  const std::size_t stride = layout.sceneStride();
  const std::size_t first = row * stride;
  if (row == 0 || row + 1 == layout.sceneRows()) {
    return 0.0;  // no tap reaches them
  }
  const Sums sums = addPrior({anchor_.data() + first, across_.data() + first, down_.data() + first},
                             direction_.data() + first, stride, stride, product_.data() + first);
  *squares += static_cast<double>(sums.squares);
  return static_cast<double>(sums.energy);
}

/// Takes a step and finds the next one. \return false: there is nothing left to do
/// \param squares of the gradient before and after the next one
bool ResidualSolver::next(MovingBlur& blur, double& squares, Step& step) {
  const SceneLayout& layout = blur.layout();
  double energy = 0.0;
  double product_squares = 0.0;
  const bool is_first = step.length == 0.0F;
  blur.applyNormalRows(
      direction_.data(), product_.data(),
      [&](std::size_t row) {
        if (!is_first) {
          advanceRow(layout, row, step);
        }
      },
      [&](std::size_t row, float* values) {
        weigh(precision_.data() + row * layout.stride(), layout.stride(), values);
      },
      [&](std::size_t row) { energy += addPriorOfRow(layout, row, &product_squares); });
  step = {};
  if (!(energy > 0.0)) {
    return false;
  }
  const double length = squares / energy;
  const double left = length * length * product_squares - squares;
  step.length = static_cast<float>(length);
  step.factor = static_cast<float>(std::max(0.0, left) / squares);
  squares = left;
  return left > 0.0;
}

/// Takes a step. \return energy of the direction after it: its product with the equations' one
double ResidualSolver::lastEnergy(MovingBlur& blur, const Step& step) {
  const SceneLayout& layout = blur.layout();
  const std::size_t stride = layout.sceneStride();
  double energy = 0.0;
  double unused = 0.0;
  blur.applyRows(
      direction_.data(),
      [&](std::size_t row) {
        advanceRow(layout, row, step);
        if (row > 0) {
          std::fill_n(product_.data() + (row - 1) * stride, stride, 0.0F);
          energy += addPriorOfRow(layout, row - 1, &unused);
        }
      },
      [&](std::size_t row, float* values) {
        energy += static_cast<double>(
            weigh(precision_.data() + row * layout.stride(), layout.stride(), values));
      });
  return energy;
}

/// Takes the last step, and measures what remains.
void ResidualSolver::finish(const Input& input, MovingBlur& blur, float length) {
  const SceneLayout& layout = blur.layout();
  const auto width = static_cast<std::size_t>(layout.size().width);
  const std::size_t stride = layout.sceneStride();
  blur.applyRows(
      solution_.data(),
      [&](std::size_t row) {
        if (length != 0.0F) {
          addScaled(direction_.data() + row * stride, stride, length,
                    solution_.data() + row * stride);
        }
      },
      [&](std::size_t row, const float* values) {
        float* after = after_.data() + row * layout.stride();
        residuals(input.blurry_dn + row * width, values, width, after);
        std::fill(after + width, after + layout.stride(), 0.0F);
      });
}

void ResidualSolver::solve(const Input& input, MovingBlur& blur) {
  resize(blur.layout());
  double squares = start(input, blur);
  Step step;
  bool goes_on = squares > 0.0;
  for (int i = 1; i < kSteps && goes_on; ++i) {
    goes_on = next(blur, squares, step);
  }
  float length = step.length;
  if (goes_on) {
    const double energy = lastEnergy(blur, step);
    length = energy > 0.0 ? static_cast<float>(squares / energy) : 0.0F;
  }
  finish(input, blur, length);
}

std::size_t ResidualSolver::memoryBytes() const {
  std::size_t floats = 0;
  for (const std::vector<float>* plane :
       {&given_, &solution_, &anchor_, &across_, &down_, &precision_, &before_, &after_,
        &direction_, &gradient_, &product_}) {
    floats += plane->capacity();
  }
  return floats * sizeof(float);
}

}  // namespace fast_edi
