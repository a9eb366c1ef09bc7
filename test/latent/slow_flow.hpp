/// \file
/// Optical flow as its header says it, in double precision: windows are summed pixel by pixel.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "support/field.hpp"

namespace fast_edi::testing {

class SlowFlow {
 public:
  struct Vector {
    double x = 0.0;
    double y = 0.0;
  };
  using Image = DoubleImage;
  using Flow = Field<Vector>;

  /// \return displacements of each pixel from one image to the other
  static Flow flow(SensorSize size, const std::vector<float>& from, const std::vector<float>& to) {
    std::vector<Image> from_levels = {halved(imageOf(size, from), half(size))};
    std::vector<Image> to_levels = {halved(imageOf(size, to), half(size))};
    while (from_levels.size() < 4 &&
           std::min(from_levels.back().size.width, from_levels.back().size.height) >= 16) {
      const SensorSize coarser = half(from_levels.back().size);
      from_levels.push_back(halved(from_levels.back(), coarser));
      to_levels.push_back(halved(to_levels.back(), coarser));
    }
    Flow found{from_levels.back().size};
    for (std::size_t level = from_levels.size(); level-- > 0;) {
      refine(from_levels[level], to_levels[level], found);
      refine(from_levels[level], to_levels[level], found);
      found = doubled(found, level > 0 ? from_levels[level - 1].size : size);
    }
    return found;
  }

 private:
  struct Terms {
    double xx = 0.0, xy = 0.0, yy = 0.0, xr = 0.0, yr = 0.0;

    void add(const Terms& other, double weight) {
      xx += weight * other.xx;
      xy += weight * other.xy;
      yy += weight * other.yy;
      xr += weight * other.xr;
      yr += weight * other.yr;
    }
  };
  static constexpr int kRadius = 5;
  static constexpr double kLambda = 20.0;

  static SensorSize half(SensorSize size) { return {(size.width + 1) / 2, (size.height + 1) / 2}; }
  /// Box means twice are one window: as many pairs of steps lead from one pixel to the other.
  static double weight(int from, int to, int length) {
    int ways = 0;
    for (int by = std::max(0, from - kRadius); by <= std::min(length - 1, from + kRadius); ++by) {
      ways += std::abs(to - by) <= kRadius ? 1 : 0;
    }
    return ways;
  }

  static void refine(const Image& from, const Image& to, Flow& flow) {
    const SensorSize size = from.size;
    const Image warped = fieldOf<double>(size, [&](int x, int y) {
      const Vector u = flow.at(x, y);
      return between(to, x + u.x, y + u.y);
    });
    const auto terms = fieldOf<Terms>(size, [&](int x, int y) {
      const Vector u = flow.at(x, y);
      if (!from.holds(x + u.x, y + u.y)) return Terms{};
      const auto mean = [&](int i, int j) { return (from.at(i, j) + warped.at(i, j)) / 2.0; };
      const double gx = (mean(x + 1, y) - mean(x - 1, y)) / 2.0;
      const double gy = (mean(x, y + 1) - mean(x, y - 1)) / 2.0;
      const double r = from.at(x, y) - warped.at(x, y) + gx * u.x + gy * u.y;
      return Terms{gx * gx, gx * gy, gy * gy, gx * r, gy * r};
    });
    const double hold = kLambda * std::pow(2 * kRadius + 1, 4);
    flow = fieldOf<Vector>(size, [&](int x, int y) {
      Terms sum;
      for (int v = std::max(0, y - 2 * kRadius); v <= std::min(size.height - 1, y + 2 * kRadius);
           ++v) {
        for (int u = std::max(0, x - 2 * kRadius); u <= std::min(size.width - 1, x + 2 * kRadius);
             ++u) {
          sum.add(terms.at(u, v), weight(x, u, size.width) * weight(y, v, size.height));
        }
      }
      const Vector before = flow.at(x, y);
      const double xx = sum.xx + hold;
      const double yy = sum.yy + hold;
      const double xr = sum.xr + hold * before.x;
      const double yr = sum.yr + hold * before.y;
      const double determinant = xx * yy - sum.xy * sum.xy;
      return Vector{(yy * xr - sum.xy * yr) / determinant, (xx * yr - sum.xy * xr) / determinant};
    });
  }
  static Flow doubled(const Flow& coarse, SensorSize size) {
    return fieldOf<Vector>(size, [&](int x, int y) {
      const auto mixed = [&](auto component) {
        const auto along = [&](int row) {
          return 0.75 * component(coarse.at(x / 2, row)) +
                 0.25 * component(coarse.at(x % 2 == 0 ? x / 2 - 1 : x / 2 + 1, row));
        };
        return 2.0 * (0.75 * along(y / 2) + 0.25 * along(y % 2 == 0 ? y / 2 - 1 : y / 2 + 1));
      };
      return Vector{mixed([](Vector u) { return u.x; }), mixed([](Vector u) { return u.y; })};
    });
  }
};

}  // namespace fast_edi::testing
