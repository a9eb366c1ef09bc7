#include "reblur/motion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "base/vector_clones.hpp"
#include "reblur/scene_layout.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kParts = ImageMotion::kParts;
constexpr std::size_t kUnknowns = 2 * kParts;
constexpr std::size_t kMostPixels = 1200;
constexpr std::size_t kFewestPixels = 60;
constexpr float kLeastCount = 1.5F;  ///< of a chosen pixel
constexpr int kMostSteps = 6;
constexpr double kConverged_px = 0.05;
/// Of the robust weights, in contrast thresholds; the finest level first.
constexpr std::array<float, 3> kSpread = {6.0F, 3.0F, 2.0F};
/// What is expected before any event is looked at: velocities, curvatures and tilts [px]. It
/// decides only what the events leave open.
constexpr double kUsualVelocity_px = 30.0;
constexpr double kUsualCurvature_px = 10.0;
constexpr double kUsualTilt_px = 3.0;
constexpr std::size_t kFirstTilt = 4;  ///< of the parts
/// S is raised by this, halved where n' is kHalfRaised.
constexpr float kRaise = 0.25F;
constexpr float kHalfRaised = 5.0F;
/// Pixels that count as one.
constexpr double kCorrelated = 4.0;
constexpr float kHalf = 0.5F;
constexpr float kQuarter = 0.25F;

using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Vector = Eigen::Matrix<double, kUnknowns, 1>;

SensorSize halved(SensorSize size) {
  return {size.width / 2, size.height / 2};
}

FAST_EDI_VECTOR_CLONES
void halveRow(const float* __restrict upper, const float* __restrict lower, std::size_t width,
              float* __restrict out) {
  for (std::size_t x = 0; x < width; ++x) {
    out[x] = kQuarter * ((upper[2 * x] + upper[2 * x + 1]) + (lower[2 * x] + lower[2 * x + 1]));
  }
}

/// Means over 2 x 2 pixels.
void halve(const std::vector<float>& plane, SensorSize size, std::vector<float>& half) {
  const SensorSize half_size = halved(size);
  const auto width = static_cast<std::size_t>(size.width);
  const auto half_width = static_cast<std::size_t>(half_size.width);
  half.resize(half_size.pixelCount());
  for (std::size_t y = 0; y < static_cast<std::size_t>(half_size.height); ++y) {
    const float* upper = plane.data() + 2 * y * width;
    halveRow(upper, upper + width, half_width, half.data() + y * half_width);
  }
}

/// 1/4, 1/2, 1/4 of three planes or rows.
FAST_EDI_VECTOR_CLONES
void binomial(const float* __restrict a, const float* __restrict b, const float* __restrict c,
              std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = kQuarter * ((a[i] + c[i]) + 2.0F * b[i]);
  }
}

FAST_EDI_VECTOR_CLONES
void raise(const float* __restrict in, const float* __restrict count, std::size_t pixels,
           float* __restrict out) {
  for (std::size_t i = 0; i < pixels; ++i) {
    const float n = count[i] * (1.0F / kHalfRaised);
    out[i] = in[i] * (1.0F + kRaise / (1.0F + n * n));
  }
}

/// Sums of weighted products of one plane with itself and those before it, and with the residuals.
/// \param planes \p last + 1 of them, and the residuals behind them
/// \param count of whole blocks
FAST_EDI_VECTOR_CLONES
void addProducts(const float* const* planes, std::size_t last, const float* weight,
                 const float* residual, std::size_t count, float* squares, float* product) {
  FloatBlock sums[kParts] = {};
  FloatBlock with_residual = {};
  for (std::size_t i = 0; i < count; i += kFloatBlock) {
    FloatBlock weighted;
    FloatBlock value;
    std::memcpy(&weighted, weight + i, sizeof(weighted));
    std::memcpy(&value, planes[last] + i, sizeof(value));
    weighted *= value;
    std::memcpy(&value, residual + i, sizeof(value));
    with_residual += weighted * value;
    for (std::size_t j = 0; j <= last; ++j) {
      std::memcpy(&value, planes[j] + i, sizeof(value));
      sums[j] += weighted * value;
    }
  }
  for (std::size_t k = 0; k < kFloatBlock; ++k) {
    *product += with_residual[k];
    for (std::size_t j = 0; j <= last; ++j) {
      squares[j] += sums[j][k];
    }
  }
}

}  // namespace

/// Of the residuals at one instant: J^T W J and J^T W r of B(x) c.
struct MotionFit::Sums {
  float squares[kParts][kParts] = {};  ///< the lower half
  float products[kParts] = {};
  float weight = 0.0F;
  float residuals = 0.0F;  ///< weighted squares
};

/// Normal equations of c1 and c2.
struct MotionFit::Equations {
  Matrix matrix = Matrix::Zero();
  Vector right = Vector::Zero();
  double weight = 0.0;
  double residuals = 0.0;

  double variance() const {
    constexpr double kLeast = 1e-6;
    return std::max(kLeast, residuals / std::max(1.0, weight));
  }
};

MotionFit::MotionFit(SensorSize size) : size_(size) {
  for (Level& level : levels_) {
    level.size = size;
    size = halved(size);
  }
}

void MotionFit::smooth(std::vector<float>& plane) {
  const auto width = static_cast<std::size_t>(size_.width);
  const auto height = static_cast<std::size_t>(size_.height);
  rows_.resize(plane.size());
  for (std::size_t y = 0; y < height; ++y) {
    const float* above = plane.data() + (y > 0 ? y - 1 : 0) * width;
    const float* below = plane.data() + std::min(y + 1, height - 1) * width;
    binomial(above, plane.data() + y * width, below, width, rows_.data() + y * width);
  }
  for (std::size_t y = 0; y < height; ++y) {
    const float* row = rows_.data() + y * width;
    float* out = plane.data() + y * width;
    binomial(row, row + 1, row + 2, width - 2, out + 1);
    out[0] = kQuarter * (3.0F * row[0] + row[1]);
    out[width - 1] = kQuarter * (3.0F * row[width - 1] + row[width - 2]);
  }
}

void MotionFit::load(const float* log_image, const EventChanges& changes,
                     const float* mean_counts) {
  const std::size_t pixels = size_.pixelCount();
  Level& finest = levels_.front();
  finest.log_image.assign(log_image, log_image + pixels);
  finest.count.assign(mean_counts, mean_counts + pixels);
  smooth(finest.log_image);
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    finest.change[k].resize(pixels);
    raise(changes.at(k).data(), mean_counts, pixels, finest.change[k].data());
    smooth(finest.change[k]);
  }
  for (std::size_t i = 1; i < kLevels; ++i) {
    const Level& finer = levels_[i - 1];
    Level& level = levels_[i];
    halve(finer.log_image, finer.size, level.log_image);
    halve(finer.count, finer.size, level.count);
    for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
      halve(finer.change[k], finer.size, level.change[k]);
    }
  }
}

void MotionFit::fillTexels(Level& level) {
  const auto width = static_cast<std::size_t>(level.size.width);
  const auto height = static_cast<std::size_t>(level.size.height);
  level.texels.resize(level.log_image.size());
  for (std::size_t y = 1; y + 1 < height; ++y) {
    const float* row = level.log_image.data() + y * width;
    Texel* texels = level.texels.data() + y * width;
    for (std::size_t x = 1; x + 1 < width; ++x) {
      texels[x] = {row[x], kHalf * (row[x + 1] - row[x - 1]),
                   kHalf * (row[x + width] - *(row + x - width)), 0.0F};
    }
  }
}

/// Pixels with events, inside the border; of many, evenly spaced ones.
void MotionFit::choosePixels(Level& level) {
  const auto width = static_cast<std::size_t>(level.size.width);
  const auto height = static_cast<std::size_t>(level.size.height);
  std::vector<std::uint32_t>& chosen = level.chosen;
  chosen.clear();
  for (std::size_t y = 1; y + 1 < height; ++y) {
    for (std::size_t x = 1; x + 1 < width; ++x) {
      if (level.count[y * width + x] >= kLeastCount) {
        chosen.push_back(static_cast<std::uint32_t>(y * width + x));
      }
    }
  }
  const std::size_t count = chosen.size();
  if (count > kMostPixels) {
    for (std::size_t i = 0; i < kMostPixels; ++i) {
      chosen[i] = chosen[i * count / kMostPixels];
    }
    chosen.resize(kMostPixels);
  }
}

MotionFit::Sums MotionFit::sumAt(const Level& level, std::size_t instant, float scale,
                                 const ImageMotion& motion, float spread) {
  const ImageMotion::Parts c = motion.at(EventChanges::kTau[instant]);
  const auto width = static_cast<std::uint32_t>(level.size.width);
  const auto right = static_cast<float>(level.size.width - 2);
  const auto bottom = static_cast<float>(level.size.height - 2);
  const float precision = 1.0F / (spread * spread);
  const float per_px = 1.0F / scale;
  const std::vector<float>& change = level.change[instant];
  Sums sums;
  for (std::vector<float>& plane : samples_) {
    plane.clear();
  }
  for (const std::uint32_t pixel : level.chosen) {
    const std::uint32_t pixel_row = pixel / width;
    const auto column = static_cast<float>(pixel % width);
    const auto row = static_cast<float>(pixel_row);
    const float at_x = (column + kHalf) * scale - kHalf;  // at full resolution
    const float at_y = (row + kHalf) * scale - kHalf;
    const Displacement u = motion.displace(c, at_x, at_y);
    const float x = column + u.x * per_px;
    const float y = row + u.y * per_px;
    if (!(x >= 1.0F && y >= 1.0F && x < right - 1.0F && y < bottom - 1.0F)) {
      continue;
    }
    const auto left = static_cast<std::uint32_t>(x);
    const auto top = static_cast<std::uint32_t>(y);
    const float fx = x - static_cast<float>(left);
    const float fy = y - static_cast<float>(top);
    const Texel* upper = level.texels.data() + std::size_t{top} * width + left;
    const Texel* lower = upper + width;
    const auto between = [&](float Texel::*part) {
      const float above = upper[0].*part + fx * (upper[1].*part - upper[0].*part);
      const float below = lower[0].*part + fx * (lower[1].*part - lower[0].*part);
      return above + fy * (below - above);
    };
    const float residual = between(&Texel::value) - level.log_image[pixel] - change[pixel];
    const float root = 1.0F / (1.0F + residual * residual * precision);
    const float weight = root * root;
    const float gx = per_px * between(&Texel::x);
    const float gy = per_px * between(&Texel::y);
    const float from_x = motion.relativeX(at_x);
    const float from_y = motion.relativeY(at_y);
    const float zoom = gx * from_x + gy * from_y;
    const float slope[kParts] = {gx,           gy, zoom, gy * from_x - gx * from_y, zoom * from_x,
                                 zoom * from_y};
    for (std::size_t i = 0; i < kParts; ++i) {
      samples_[i].push_back(slope[i]);
    }
    samples_[kWeights].push_back(weight);
    samples_[kResiduals].push_back(residual);
    sums.weight += weight;
    sums.residuals += weight * residual * residual;
  }
  const std::size_t blocks = (samples_[kWeights].size() + kFloatBlock - 1) / kFloatBlock;
  std::array<const float*, kParts> planes{};
  for (std::vector<float>& plane : samples_) {
    plane.resize(blocks * kFloatBlock, 0.0F);  // weights of 0
  }
  for (std::size_t i = 0; i < kParts; ++i) {
    planes[i] = samples_[i].data();
    addProducts(planes.data(), i, samples_[kWeights].data(), samples_[kResiduals].data(),
                blocks * kFloatBlock, sums.squares[i], &sums.products[i]);
  }
  return sums;
}

MotionFit::Equations MotionFit::linearise(const Level& level, float scale,
                                          const ImageMotion& motion, float spread) {
  Equations equations;
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    const Sums sums = sumAt(level, k, scale, motion, spread);
    const auto tau = static_cast<double>(EventChanges::kTau[k]);
    const double factors[2] = {tau, tau * tau};  // of c1 and c2
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      const std::size_t row = i % kParts;
      const double factor = factors[i / kParts];
      equations.right[static_cast<Eigen::Index>(i)] +=
          factor * static_cast<double>(sums.products[row]);
      for (std::size_t j = 0; j < kUnknowns; ++j) {
        const std::size_t column = j % kParts;
        const float square = sums.squares[std::max(row, column)][std::min(row, column)];
        equations.matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
            factor * factors[j / kParts] * static_cast<double>(square);
      }
    }
    equations.weight += static_cast<double>(sums.weight);
    equations.residuals += static_cast<double>(sums.residuals);
  }
  const double variance = equations.variance();
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    const bool is_tilt = i % kParts >= kFirstTilt;
    const double usual = is_tilt      ? kUsualTilt_px
                         : i < kParts ? kUsualVelocity_px
                                      : kUsualCurvature_px;
    const double precision = variance / (usual * usual);
    const float value = i < kParts ? motion.velocity[i] : motion.curvature[i - kParts];
    equations.matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += precision;
    equations.right[static_cast<Eigen::Index>(i)] += precision * static_cast<double>(value);
  }
  return equations;
}

FittedMotion MotionFit::fit(const float* log_image, const EventChanges& changes,
                            const float* mean_counts, float contrast) {
  load(log_image, changes, mean_counts);
  FittedMotion fitted;
  fitted.motion = ImageMotion(size_);
  Equations equations;
  for (std::size_t i = kLevels; i-- > 0;) {
    Level& level = levels_[i];
    choosePixels(level);
    if (level.chosen.size() < kFewestPixels) {
      continue;
    }
    fillTexels(level);
    const auto scale = static_cast<float>(1u << i);
    double largest = kConverged_px;
    for (int step = 0; step < kMostSteps && largest >= kConverged_px; ++step) {
      equations = linearise(level, scale, fitted.motion, kSpread[i] * contrast);
      const Vector change = equations.matrix.ldlt().solve(equations.right);
      for (std::size_t part = 0; part < kParts; ++part) {
        const auto index = static_cast<Eigen::Index>(part);
        fitted.motion.velocity[part] -= static_cast<float>(change[index]);
        fitted.motion.curvature[part] -=
            static_cast<float>(change[index + static_cast<Eigen::Index>(kParts)]);
      }
      largest = change.cwiseAbs().maxCoeff();
    }
  }
  if (levels_.front().chosen.size() >= kFewestPixels) {
    measure(equations, fitted);
  }
  return fitted;
}

/// Over corners and centre of the image at start and end.
void MotionFit::measure(const Equations& equations, FittedMotion& fitted) const {
  const Matrix covariance =
      kCorrelated * equations.variance() * equations.matrix.ldlt().solve(Matrix::Identity());
  const auto right = static_cast<float>(size_.width - 1);
  const auto bottom = static_cast<float>(size_.height - 1);
  const std::array<Displacement, 5> places = {{{0.0F, 0.0F},
                                               {right, 0.0F},
                                               {0.0F, bottom},
                                               {right, bottom},
                                               {kHalf * right, kHalf * bottom}}};
  double largest_variance = 0.0;
  float ways = 0.0F;
  for (const Displacement& place : places) {
    const auto x = static_cast<double>(fitted.motion.relativeX(place.x));
    const auto y = static_cast<double>(fitted.motion.relativeY(place.y));
    for (const double tau : {-1.0, 1.0}) {
      const Displacement u = fitted.motion.displacement(place.x, place.y, static_cast<float>(tau));
      const float way = std::hypot(u.x, u.y);
      ways += way;
      fitted.reach_px = std::max(fitted.reach_px, way);
      Eigen::Matrix<double, 2, static_cast<int>(kParts)> basis;
      basis << 1.0, 0.0, x, -y, x * x, x * y,  //
          0.0, 1.0, y, x, x * y, y * y;
      Eigen::Matrix<double, 2, static_cast<int>(kUnknowns)> slope;
      slope << tau * basis, basis;
      const Eigen::Matrix2d variance = slope * covariance * slope.transpose();
      largest_variance = std::max(largest_variance, 0.5 * variance.trace());
    }
  }
  fitted.path_px = ways / static_cast<float>(places.size());
  fitted.deviation_px = static_cast<float>(std::sqrt(largest_variance));
  fitted.found = std::isfinite(fitted.path_px) && std::isfinite(fitted.deviation_px);
}

std::size_t MotionFit::memoryBytes() const {
  std::size_t bytes = rows_.capacity() * sizeof(float);
  for (const Level& level : levels_) {
    bytes += (level.log_image.capacity() + level.count.capacity()) * sizeof(float) +
             level.texels.capacity() * sizeof(Texel) +
             level.chosen.capacity() * sizeof(std::uint32_t);
    for (const std::vector<float>& change : level.change) {
      bytes += change.capacity() * sizeof(float);
    }
  }
  return bytes;
}

}  // namespace fast_edi
