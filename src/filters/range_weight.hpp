/// \file
/// How much a difference counts as noise, in place of a Gaussian of it.
///
///     max(0, 1 - d^2 / (8 sigma^2))^4
///
/// is within 0.06 of exp(-d^2 / (2 sigma^2)), reaches zero, and needs no exp.
#pragma once

#include <cmath>

namespace fast_edi {

/// Sixteen times the weight is the square of rangeWeightRoot().
constexpr float kRangeWeightScale = 1.0F / 16.0F;

/// 1 / (8 sigma^2), for rangeWeightRoot().
constexpr float inverseRange(float sigma) {
  return 1.0F / (8.0F * sigma * sigma);
}

/// \param difference of the unit of sigma
inline float rangeWeightRoot(float difference, float inverse_range) {
  const float t = 1.0F - difference * difference * inverse_range;
  // Twice max(0, t), without a comparison, which would keep GCC from vectorising loops.
  const float twice = t + std::fabs(t);
  return twice * twice;
}

}  // namespace fast_edi
