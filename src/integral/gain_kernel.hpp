/// \file
/// From every pixel's two half integrals to its gain.
#pragma once

#include <cstddef>

#include "integral/fold_kernel.hpp"

namespace fast_edi {

/// Stands for a gain that cannot be computed; no other gain is below kMinGain.
constexpr float kOutOfRange = 0.0F;

/// Clocks of an interval's ends, counted from the base instant of its sums.
struct IntervalClock {
  double start = 0.0;
  double end = 0.0;

  double length() const { return end - start; }
};

/// The results of all pixels over one interval: integral_i = sum_i + value_i clock.end -
/// clock.start.
struct IntervalSums {
  PixelSums* sums = nullptr;
  IntervalClock clock;
};

/// Gains from the integral A over [start, f), relative to the start, and B over [f, end), relative
/// to the reference time f:
///
///     gain = 1 / E(f) = T v(f) / (A + v(f) B),   T = length(A) + length(B)
///
/// kept within [kMinGain, kMaxGain]; kOutOfRange where the denominator is not a
/// positive number or the ratio not a number. Resets all sums to those of no event in the same
/// sweep.
void takeGains(const IntervalSums& before, const IntervalSums& after, std::size_t pixels,
               float* gain);

/// Replaces each kOutOfRange by 1. \return how many there were
std::size_t replaceOutOfRange(std::size_t pixels, float* gain);

}  // namespace fast_edi
