/// \file
/// The fit of a motion as its header says it, pixel by pixel and in double precision. Steps and
/// measures are those of MotionEquations.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "reblur/event_changes.hpp"
#include "reblur/motion_equations.hpp"
#include "support/field.hpp"

namespace fast_edi::testing {

class SlowMotionFit {
 public:
  SlowMotionFit(SensorSize size, const std::vector<float>& log_image, const EventChanges& changes,
                const std::vector<float>& mean_counts)
      : size_(size) {
    Level finest{imageOf(size, log_image), imageOf(size, mean_counts), {}, {}};
    Level level{smoothed(finest.log_image), finest.count, {}, {}};
    for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
      finest.change[k] = imageOf(size, changes.at(k));
      level.change[k] = raised(smoothed(finest.change[k]), level.count);
    }
    levels_.push_back(level);
    for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
      level.change[k] = finest.change[k];
    }
    while (levels_.size() < 3) {
      const SensorSize coarser = half(level.log_image.size);
      level.log_image = halved(level.log_image, coarser);
      level.count = halved(level.count, coarser);
      for (Image& change : level.change) {
        change = halved(change, coarser);
        // Of coarser levels, means of what is raised already.
        if (levels_.size() == 1) change = raised(change, level.count);
      }
      levels_.push_back(level);
    }
    for (std::size_t i = 0; i < levels_.size(); ++i) levels_[i].chosen = choose(i);
  }

  FittedMotion fit(double contrast) const {
    constexpr std::size_t kFewest = 60;
    constexpr int kSteps[] = {3, 3, 6};
    constexpr double kSpreads[] = {6.0, 3.0, 2.0};  // in contrast thresholds
    contrast = std::max(contrast, 0.1);
    FittedMotion fitted;
    fitted.motion = ImageMotion(size_);
    for (std::size_t i = levels_.size(); i-- > 0;) {
      if (levels_[i].chosen.size() < kFewest) continue;
      for (int step = 0; step < kSteps[i]; ++step) {
        if (linearised(i, kSpreads[i] * contrast, fitted).step(false, fitted) < 0.05) break;
      }
    }
    if (levels_.front().chosen.size() < kFewest) return fitted;
    const double spread = kSpreads[0] * contrast;
    MotionEquations equations = linearised(0, spread, fitted);
    MotionEquations freed_equations = equations;
    FittedMotion freed = fitted;
    bool some_are_lost = true;
    for (int step = 0; step < 3 && some_are_lost; ++step) {
      freed_equations.step(true, freed);
      some_are_lost = freed.event_share <= 0.97F;
      freed_equations = linearised(0, spread, freed);
    }
    if (some_are_lost && freed.event_share >= 0.75F &&
        freed_equations.variance() < 0.97 * equations.variance()) {
      fitted = freed;
      equations = freed_equations;
    }
    equations.measure(size_, fitted);
    return fitted;
  }

 private:
  using Image = DoubleImage;
  struct Pixel {
    int x;
    int y;
  };
  struct Level {
    Image log_image;
    Image count;
    std::array<Image, EventChanges::kInstants> change;
    std::vector<Pixel> chosen;
  };

  /// By (1, 2, 1) / 4 in both directions.
  static Image smoothed(const Image& image) {
    return fieldOf<double>(image.size, [&](int x, int y) {
      double sum = 0.0;
      for (int v = -1; v <= 1; ++v) {
        for (int u = -1; u <= 1; ++u) sum += (2 - u * u) * (2 - v * v) * image.at(x + u, y + v);
      }
      return sum / 16.0;
    });
  }
  static SensorSize half(SensorSize size) { return {size.width / 2, size.height / 2}; }
  static Image raised(const Image& change, const Image& count) {
    return fieldOf<double>(change.size, [&](int x, int y) {
      return change.at(x, y) * (1.0 + 0.25 / (1.0 + std::pow(count.at(x, y) / 5.0, 2)));
    });
  }

  /// Pixels with events inside the border; of many, evenly spaced ones.
  std::vector<Pixel> choose(std::size_t level) const {
    constexpr std::size_t kMost[] = {1200, 700, 500};
    const Image& count = levels_[level].count;
    std::vector<Pixel> pixels;
    for (int y = 1; y < count.size.height - 1; ++y) {
      for (int x = 1; x < count.size.width - 1; ++x) {
        if (count.at(x, y) >= 1.5) pixels.push_back({x, y});
      }
    }
    if (pixels.size() <= kMost[level]) return pixels;
    std::vector<Pixel> some;
    for (std::size_t i = 0; i < kMost[level]; ++i) {
      some.push_back(pixels[i * pixels.size() / kMost[level]]);
    }
    return some;
  }

  MotionEquations linearised(std::size_t level_index, double spread,
                             const FittedMotion& fitted) const {
    const Level& level = levels_[level_index];
    const double scale = std::pow(2.0, static_cast<double>(level_index));
    const double share = static_cast<double>(fitted.event_share);
    MotionEquations equations;
    for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
      double squares[MotionEquations::kSlopes][MotionEquations::kSlopes] = {};
      double products[MotionEquations::kSlopes] = {};
      double weights = 0.0;
      double residuals = 0.0;
      for (const Pixel& pixel : level.chosen) {
        // Of the pixel's centre in the finest level.
        const auto x = static_cast<float>((pixel.x + 0.5) * scale - 0.5);
        const auto y = static_cast<float>((pixel.y + 0.5) * scale - 0.5);
        const Displacement u = fitted.motion.displacement(x, y, EventChanges::kTau[k]);
        const double to_x = pixel.x + static_cast<double>(u.x) / scale;
        const double to_y = pixel.y + static_cast<double>(u.y) / scale;
        if (to_x < 1.0 || to_y < 1.0 || to_x >= level.log_image.size.width - 3 ||
            to_y >= level.log_image.size.height - 3) {
          continue;
        }
        const auto log_at = [&](double dx, double dy) {
          return between(level.log_image, to_x + dx, to_y + dy);
        };
        const double change = log_at(0.0, 0.0) - level.log_image.at(pixel.x, pixel.y);
        const double r = share * change - level.change[k].at(pixel.x, pixel.y);
        const double weight = std::pow(1.0 + std::pow(r / spread, 2), -2);
        const double gx = share * (log_at(1.0, 0.0) - log_at(-1.0, 0.0)) / (2.0 * scale);
        const double gy = share * (log_at(0.0, 1.0) - log_at(0.0, -1.0)) / (2.0 * scale);
        const auto right = static_cast<double>(fitted.motion.relativeX(x));
        const auto down = static_cast<double>(fitted.motion.relativeY(y));
        const double zoom = gx * right + gy * down;
        const double slopes[] = {gx,           gy,          zoom,  gy * right - gx * down,
                                 zoom * right, zoom * down, change};
        for (std::size_t i = 0; i < MotionEquations::kSlopes; ++i) {
          for (std::size_t j = 0; j <= i; ++j) squares[i][j] += weight * slopes[i] * slopes[j];
          products[i] += weight * slopes[i] * r;
        }
        weights += weight;
        residuals += weight * r * r;
      }
      MotionEquations::Sums sums;
      for (std::size_t i = 0; i < MotionEquations::kSlopes; ++i) {
        for (std::size_t j = 0; j <= i; ++j) sums.squares[i][j] = static_cast<float>(squares[i][j]);
        sums.products[i] = static_cast<float>(products[i]);
      }
      sums.weight = static_cast<float>(weights);
      sums.residuals = static_cast<float>(residuals);
      equations.add(sums, static_cast<double>(EventChanges::kTau[k]));
    }
    equations.addPriors(fitted);
    return equations;
  }

  SensorSize size_;
  std::vector<Level> levels_;  ///< the finest first
};

}  // namespace fast_edi::testing
