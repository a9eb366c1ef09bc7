/// \file
/// Values with their first and second derivatives in time, exact by the rules of differentiation.
#pragma once

#include <cmath>

namespace fast_edi {

/// f(t), f'(t), f''(t).
struct Jet {
  double value = 0.0;
  double first = 0.0;
  double second = 0.0;
};

inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}

inline Jet operator*(double a, const Jet& b) {
  return {a * b.value, a * b.first, a * b.second};
}

inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}

/// Sine and cosine of what moves.
inline Jet sin(const Jet& a) {
  const double s = std::sin(a.value);
  const double c = std::cos(a.value);
  return {s, c * a.first, c * a.second - s * a.first * a.first};
}

inline Jet cos(const Jet& a) {
  const double s = std::sin(a.value);
  const double c = std::cos(a.value);
  return {c, -s * a.first, -s * a.second - c * a.first * a.first};
}

}  // namespace fast_edi
