/// \file
/// Images and other fields in double precision, pixel by pixel: what slow references are made of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi::testing {

/// A value for each pixel, row-major.
template <typename Value>
struct Field {
  SensorSize size;
  std::vector<Value> values = std::vector<Value>(size.pixelCount());

  /// Beyond the border the nearest pixel counts.
  Value at(int x, int y) const {
    return values[indexOf(std::clamp(x, 0, size.width - 1), std::clamp(y, 0, size.height - 1))];
  }
  /// \pre the pixel lies inside
  Value& at(int x, int y) { return values[indexOf(x, y)]; }
  bool holds(double x, double y) const {
    return x >= 0.0 && y >= 0.0 && x <= size.width - 1 && y <= size.height - 1;
  }

 private:
  std::size_t indexOf(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
           static_cast<std::size_t>(x);
  }
};
using DoubleImage = Field<double>;

/// \param function of column and row
template <typename Value, typename Function>
Field<Value> fieldOf(SensorSize size, Function function) {
  Field<Value> field{size};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) field.at(x, y) = function(x, y);
  }
  return field;
}

/// \param plane of as many values as pixels
inline DoubleImage imageOf(SensorSize size, const std::vector<float>& plane) {
  DoubleImage image{size};
  std::copy(plane.begin(), plane.end(), image.values.begin());
  return image;
}

/// Means of 2 x 2 pixels. \param size of the result: half of the image's, rounded either way
inline DoubleImage halved(const DoubleImage& fine, SensorSize size) {
  return fieldOf<double>(size, [&](int x, int y) {
    return (fine.at(2 * x, 2 * y) + fine.at(2 * x + 1, 2 * y) + fine.at(2 * x, 2 * y + 1) +
            fine.at(2 * x + 1, 2 * y + 1)) /
           4.0;
  });
}

/// Bilinear; beyond the border the nearest place counts.
inline double between(const DoubleImage& image, double x, double y) {
  x = std::clamp(x, 0.0, image.size.width - 1.0);
  y = std::clamp(y, 0.0, image.size.height - 1.0);
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const double fx = x - left;
  const double fy = y - top;
  return (1.0 - fy) * ((1.0 - fx) * image.at(left, top) + fx * image.at(left + 1, top)) +
         fy * ((1.0 - fx) * image.at(left, top + 1) + fx * image.at(left + 1, top + 1));
}

}  // namespace fast_edi::testing
