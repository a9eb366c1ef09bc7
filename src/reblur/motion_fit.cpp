#include "reblur/motion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/vector_clones.hpp"
#include "reblur/scene_layout.hpp"

namespace fast_edi {
namespace {

/// At most, of the finest level first.
constexpr std::array<std::size_t, 3> kMostPixels = {1200, 700, 500};
constexpr std::size_t kFewestPixels = 60;
constexpr float kLeastCount = 1.5F;                   ///< of a chosen pixel
constexpr std::array<int, 3> kMostSteps = {3, 3, 6};  ///< the same
constexpr double kConverged_px = 0.05;
/// Of the robust weights, in contrast thresholds; the finest level first.
constexpr std::array<float, 3> kSpread = {6.0F, 3.0F, 2.0F};
/// Where thresholds are smaller than this, noise of the image decides.
constexpr float kLeastContrast = 0.1F;
/// A share above the first is not worth a fit of its own; one below the second says that the image
/// is noisy rather than that events are lost.
constexpr float kNoneLost = 0.97F;
constexpr float kLeastShare = 0.75F;
constexpr int kFreeSteps = 3;
/// Variance of the residuals that a share must leave, of that without.
constexpr double kClearlyLess = 0.97;
/// S is raised by this, halved where n' is kHalfRaised.
constexpr float kRaise = 0.25F;
constexpr float kHalfRaised = 5.0F;
constexpr float kHalf = 0.5F;
constexpr float kQuarter = 0.25F;

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
void halve(const float* plane, SensorSize size, std::vector<float>& half) {
  const SensorSize half_size = halved(size);
  const auto width = static_cast<std::size_t>(size.width);
  const auto half_width = static_cast<std::size_t>(half_size.width);
  half.resize(half_size.pixelCount());
  for (std::size_t y = 0; y < static_cast<std::size_t>(half_size.height); ++y) {
    const float* upper = plane + 2 * y * width;
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

/// \param row scratch
void smooth(const float* plane, SensorSize size, std::vector<float>& row,
            std::vector<float>& smoothed) {
  const auto width = static_cast<std::size_t>(size.width);
  const auto height = static_cast<std::size_t>(size.height);
  row.resize(width);
  smoothed.resize(size.pixelCount());
  for (std::size_t y = 0; y < height; ++y) {
    const float* above = plane + (y > 0 ? y - 1 : 0) * width;
    const float* below = plane + std::min(y + 1, height - 1) * width;
    binomial(above, plane + y * width, below, width, row.data());
    float* out = smoothed.data() + y * width;
    binomial(row.data(), row.data() + 1, row.data() + 2, width - 2, out + 1);
    out[0] = kQuarter * (3.0F * row[0] + row[1]);
    out[width - 1] = kQuarter * (3.0F * row[width - 1] + row[width - 2]);
  }
}

/// Pixels with events, inside the border; of many, evenly spaced ones.
void choosePixels(SensorSize size, const float* counts, std::size_t most,
                  std::vector<std::uint32_t>& pixel) {
  const auto width = static_cast<std::size_t>(size.width);
  const auto height = static_cast<std::size_t>(size.height);
  pixel.resize(size.pixelCount());
  std::size_t count = 0;
  for (std::size_t y = 1; y + 1 < height; ++y) {
    for (std::size_t i = y * width + 1; i < (y + 1) * width - 1; ++i) {
      pixel[count] = static_cast<std::uint32_t>(i);
      count += counts[i] >= kLeastCount ? 1 : 0;
    }
  }
  const std::size_t kept = std::min(count, most);
  for (std::size_t i = 0; i < kept; ++i) {
    pixel[i] = pixel[i * count / kept];
  }
  pixel.resize(kept);
}

/// S is raised by this factor less one.
float raiseOf(float mean_count) {
  const float n = mean_count * (1.0F / kHalfRaised);
  return kRaise / (1.0F + n * n);
}

FAST_EDI_VECTOR_CLONES
void raise(const float* __restrict count, const float* __restrict change, std::size_t pixels,
           float* __restrict raised) {
  for (std::size_t i = 0; i < pixels; ++i) {
    const float n = count[i] * (1.0F / kHalfRaised);
    raised[i] = change[i] * (1.0F + kRaise / (1.0F + n * n));
  }
}

struct Positions {
  const float* relative_x;
  const float* relative_y;
  const float* x;
  const float* y;
};
/// Moves pixels by B(x) c.
FAST_EDI_VECTOR_CLONES
void movePixels(const Positions& from, std::size_t count, const ImageMotion::Parts& c, float per_px,
                float* __restrict x, float* __restrict y) {
  const float* __restrict right = from.relative_x;
  const float* __restrict down = from.relative_y;
  const float* __restrict from_x = from.x;
  const float* __restrict from_y = from.y;
  for (std::size_t i = 0; i < count; ++i) {
    const float zoom = c[2] + c[4] * right[i] + c[5] * down[i];
    x[i] = from_x[i] + per_px * (c[0] + zoom * right[i] - c[3] * down[i]);
    y[i] = from_y[i] + per_px * (c[1] + c[3] * right[i] + zoom * down[i]);
  }
}

/// Four pixels of a row.
using Quad = float __attribute__((vector_size(4 * sizeof(float))));

/// Value and twice the gradient between pixels, all interpolated linearly.
struct Sample {
  float value;
  float across;
  float down;
};
Sample sampleAt(const float* plane, std::ptrdiff_t width, float x, float y) {
  const auto left = static_cast<std::ptrdiff_t>(x);
  const auto top = static_cast<std::ptrdiff_t>(y);
  const float fx = x - static_cast<float>(left);
  const float fy = y - static_cast<float>(top);
  const float* from = plane + (top - 1) * width + left - 1;
  Quad above;
  Quad upper;
  Quad lower;
  Quad below;
  std::memcpy(&above, from, sizeof(above));
  std::memcpy(&upper, from + width, sizeof(upper));
  std::memcpy(&lower, from + 2 * width, sizeof(lower));
  std::memcpy(&below, from + 3 * width, sizeof(below));
  const Quad rise = lower - upper;
  const Quad value = upper + fy * rise;
  above = lower - above;
  const Quad down = above + fy * ((below - upper) - above);
  const float across = value[2] - value[0];
  return {value[1] + fx * (value[2] - value[1]), across + fx * ((value[3] - value[1]) - across),
          down[1] + fx * (down[2] - down[1])};
}

/// Weights from residuals, and slopes of the residuals by the parts of a motion.
struct SamplePlanes {
  const float* x;  ///< relative positions
  const float* y;
  const float* gradient_x;
  const float* gradient_y;
  float* zoom;
  float* turn;
  float* tilt_x;
  float* tilt_y;
  float* weight;  ///< in: 1, or 0 for what does not count
  const float* residual;
};
FAST_EDI_VECTOR_CLONES
void fillSlopes(const SamplePlanes& planes, std::size_t count, float precision) {
  for (std::size_t i = 0; i < count; i += kFloatBlock) {
    FloatBlock x;
    FloatBlock y;
    FloatBlock gradient_x;
    FloatBlock gradient_y;
    FloatBlock residual;
    FloatBlock weight;
    std::memcpy(&x, planes.x + i, sizeof(x));
    std::memcpy(&y, planes.y + i, sizeof(y));
    std::memcpy(&gradient_x, planes.gradient_x + i, sizeof(gradient_x));
    std::memcpy(&gradient_y, planes.gradient_y + i, sizeof(gradient_y));
    std::memcpy(&residual, planes.residual + i, sizeof(residual));
    std::memcpy(&weight, planes.weight + i, sizeof(weight));
    const FloatBlock root = 1.0F / (1.0F + residual * residual * precision);
    const FloatBlock zoom = gradient_x * x + gradient_y * y;
    const FloatBlock turn = gradient_y * x - gradient_x * y;
    x *= zoom;
    y *= zoom;
    weight *= root * root;
    std::memcpy(planes.weight + i, &weight, sizeof(weight));
    std::memcpy(planes.zoom + i, &zoom, sizeof(zoom));
    std::memcpy(planes.turn + i, &turn, sizeof(turn));
    std::memcpy(planes.tilt_x + i, &x, sizeof(x));
    std::memcpy(planes.tilt_y + i, &y, sizeof(y));
  }
}

/// Sums of weighted products of one plane with itself and those before it, and with the residuals.
/// \param planes \p last + 1 of them, and the residuals behind them
/// \param count of whole blocks
FAST_EDI_VECTOR_CLONES
void addProducts(const float* const* planes, std::size_t last, const float* weight,
                 const float* residual, std::size_t count, float* squares, float* product) {
  FloatBlock sums[MotionEquations::kSlopes] = {};
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

std::size_t capacityOf(const std::vector<float>* planes, std::size_t count) {
  std::size_t floats = 0;
  for (std::size_t i = 0; i < count; ++i) {
    floats += planes[i].capacity();
  }
  return floats;
}

}  // namespace

MotionFit::MotionFit(SensorSize size) : size_(size) {
  for (Level& level : levels_) {
    level.size = size;
    size = halved(size);
  }
}

void MotionFit::load(const float* log_image, const EventChanges& changes,
                     const float* mean_counts) {
  smooth(log_image, size_, row_, levels_.front().log_image);
  for (std::size_t i = 1; i < kLevels; ++i) {
    const Level& finer = levels_[i - 1];
    Level& level = levels_[i];
    halve(finer.log_image.data(), finer.size, level.log_image);
    halve(i == 1 ? mean_counts : finer.count.data(), finer.size, level.count);
    for (std::size_t k = 0; k < kInstants; ++k) {
      if (i == 1) {
        level.change[k].resize(level.count.size());
        raise(level.count.data(), changes.halvedAt(k).data(), level.count.size(),
              level.change[k].data());
      } else {
        halve(finer.change[k].data(), finer.size, level.change[k]);
      }
    }
  }
}

/// Changes of the finest level are smoothed as its image is, but only where they are looked at.
void MotionFit::loadChosen(const EventChanges& changes, const float* mean_counts,
                           std::size_t level_index) {
  const Level& level = levels_[level_index];
  const auto width = static_cast<std::uint32_t>(level.size.width);
  const std::size_t count = chosen_.size();
  chosen_.x.resize(count);
  chosen_.y.resize(count);
  chosen_.value.resize(count);
  relative_x_.assign((count + kFloatBlock - 1) / kFloatBlock * kFloatBlock, 0.0F);
  relative_y_.assign(relative_x_.size(), 0.0F);
  const ImageMotion still(size_);
  const auto scale = static_cast<float>(1u << level_index);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t pixel = chosen_.pixel[i];
    const std::uint32_t row = pixel / width;
    chosen_.x[i] = static_cast<float>(pixel % width);
    chosen_.y[i] = static_cast<float>(row);
    chosen_.value[i] = level.log_image[pixel];
    relative_x_[i] = still.relativeX((chosen_.x[i] + kHalf) * scale - kHalf);
    relative_y_[i] = still.relativeY((chosen_.y[i] + kHalf) * scale - kHalf);
  }
  for (std::size_t k = 0; k < kInstants; ++k) {
    std::vector<float>& out = chosen_.change[k];
    out.resize(count);
    const float* change = level_index == 0 ? changes.at(k).data() : level.change[k].data();
    for (std::size_t i = 0; i < count; ++i) {
      const float* at = change + chosen_.pixel[i];
      if (level_index > 0) {
        out[i] = *at;
        continue;
      }
      const auto across = [](const float* row) {
        return kQuarter * ((row[-1] + row[1]) + 2.0F * row[0]);
      };
      const float smoothed =
          kQuarter * ((across(at - width) + across(at + width)) + 2.0F * across(at));
      out[i] = smoothed * (1.0F + raiseOf(mean_counts[chosen_.pixel[i]]));
    }
  }
}

/// Residuals and gradients where the chosen pixels have moved to; weight 0 for what left the image.
void MotionFit::samplePixels(const Level& level, std::size_t instant, float scale,
                             const FittedMotion& fitted) {
  const auto width = static_cast<std::ptrdiff_t>(level.size.width);
  const auto right = static_cast<float>(level.size.width - 3);
  const auto bottom = static_cast<float>(level.size.height - 3);
  const float per_px = 1.0F / scale;
  const float half_per_px = kHalf * per_px * fitted.event_share;
  const std::vector<float>& change = chosen_.change[instant];
  moved_x_.resize(relative_x_.size());
  moved_y_.resize(relative_x_.size());
  movePixels({relative_x_.data(), relative_y_.data(), chosen_.x.data(), chosen_.y.data()},
             chosen_.size(), fitted.motion.at(EventChanges::kTau[instant]), per_px, moved_x_.data(),
             moved_y_.data());
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const float x = moved_x_[i];
    const float y = moved_y_[i];
    const bool inside = x >= 1.0F && y >= 1.0F && x < right && y < bottom;
    const Sample sample = inside ? sampleAt(level.log_image.data(), width, x, y) : Sample{};
    const float share = inside ? sample.value - chosen_.value[i] : 0.0F;
    samples_[kShare][i] = share;
    samples_[kResidual][i] = inside ? fitted.event_share * share - change[i] : 0.0F;
    samples_[kGradientX][i] = half_per_px * sample.across;
    samples_[kGradientY][i] = half_per_px * sample.down;
    samples_[kWeight][i] = inside ? 1.0F : 0.0F;
  }
}

MotionEquations::Sums MotionFit::sumAt(const Level& level, std::size_t instant, float scale,
                                       const FittedMotion& fitted, float spread) {
  const std::size_t blocks = (chosen_.size() + kFloatBlock - 1) / kFloatBlock;
  const std::size_t count = blocks * kFloatBlock;
  for (std::vector<float>& plane : samples_) {
    plane.resize(count);
    std::fill(plane.begin() + static_cast<std::ptrdiff_t>(chosen_.size()), plane.end(), 0.0F);
  }
  samplePixels(level, instant, scale, fitted);
  fillSlopes({relative_x_.data(), relative_y_.data(), samples_[kGradientX].data(),
              samples_[kGradientY].data(), samples_[kZoom].data(), samples_[kTurn].data(),
              samples_[kTiltX].data(), samples_[kTiltY].data(), samples_[kWeight].data(),
              samples_[kResidual].data()},
             count, 1.0F / (spread * spread));
  MotionEquations::Sums sums;
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const float residual = samples_[kResidual][i];
    sums.weight += samples_[kWeight][i];
    sums.residuals += samples_[kWeight][i] * residual * residual;
  }
  std::array<const float*, MotionEquations::kSlopes> planes{};
  for (std::size_t i = 0; i < MotionEquations::kSlopes; ++i) {
    planes[i] = samples_[i].data();
    addProducts(planes.data(), i, samples_[kWeight].data(), samples_[kResidual].data(), count,
                sums.squares[i], &sums.products[i]);
  }
  return sums;
}

MotionEquations MotionFit::linearise(const Level& level, float scale, const FittedMotion& fitted,
                                     float spread) {
  MotionEquations equations;
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    equations.add(sumAt(level, k, scale, fitted, spread),
                  static_cast<double>(EventChanges::kTau[k]));
  }
  equations.addPriors(fitted);
  return equations;
}

/// Frees the share of events, and keeps what comes of it where it explains clearly more.
/// \param equations of fitted at the finest level; of the result when it returns
void MotionFit::findLostEvents(float spread, MotionEquations& equations, FittedMotion& fitted) {
  FittedMotion freed = fitted;
  MotionEquations freed_equations = equations;
  for (int i = 0; i < kFreeSteps; ++i) {
    freed_equations.step(true, freed);
    if (freed.event_share > kNoneLost) {
      return;
    }
    freed_equations = linearise(levels_.front(), 1.0F, freed, spread);
  }
  if (freed.event_share >= kLeastShare &&
      freed_equations.variance() < kClearlyLess * equations.variance()) {
    fitted = freed;
    equations = freed_equations;
  }
}

FittedMotion MotionFit::fit(const float* log_image, const EventChanges& changes,
                            const float* mean_counts, float contrast) {
  load(log_image, changes, mean_counts);
  FittedMotion fitted;
  fitted.motion = ImageMotion(size_);
  const auto spread_at = [contrast](std::size_t level) {
    return kSpread[level] * std::max(contrast, kLeastContrast);
  };
  for (std::size_t i = kLevels; i-- > 0;) {
    const Level& level = levels_[i];
    choosePixels(level.size, i == 0 ? mean_counts : level.count.data(), kMostPixels[i],
                 chosen_.pixel);
    if (chosen_.size() < kFewestPixels) {
      continue;
    }
    loadChosen(changes, mean_counts, i);
    const auto scale = static_cast<float>(1u << i);
    double largest = kConverged_px;
    for (int n = 0; n < kMostSteps[i] && largest >= kConverged_px; ++n) {
      largest = linearise(level, scale, fitted, spread_at(i)).step(false, fitted);
    }
  }
  if (chosen_.size() >= kFewestPixels) {  // of the finest level
    MotionEquations equations = linearise(levels_.front(), 1.0F, fitted, spread_at(0));
    findLostEvents(spread_at(0), equations, fitted);
    equations.measure(size_, fitted);
  }
  return fitted;
}

std::size_t MotionFit::memoryBytes() const {
  std::size_t floats =
      row_.capacity() + relative_x_.capacity() + relative_y_.capacity() + moved_x_.capacity() +
      moved_y_.capacity() + chosen_.x.capacity() + chosen_.y.capacity() + chosen_.value.capacity() +
      capacityOf(chosen_.change.data(), kInstants) + capacityOf(samples_.data(), kPlanes);
  for (const Level& level : levels_) {
    floats += level.log_image.capacity() + level.count.capacity() +
              capacityOf(level.change.data(), kInstants);
  }
  return floats * sizeof(float) + chosen_.pixel.capacity() * sizeof(std::uint32_t);
}

}  // namespace fast_edi
