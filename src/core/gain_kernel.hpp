/// \file
/// From every pixel's running result to its gain, and back to the result of no event.
#pragma once

#include <cstddef>

#include "fold_kernel.hpp"

namespace fast_edi {

/// Clocks of a window's ends, counted from the base instant.
struct WindowClock {
  double start;
  double end;
};

/// gain[i] = T v_i(f) / integral_i with integral = sum + v end - start and T = end - start, kept
/// within [DoubleIntegral::kMinGain, kMaxGain]; 1 where the integral is not a positive number or
/// the ratio not a number. Resets sums[i] to {0, 1} in the same sweep. \return the number of pixels
/// that got 1 for the latter reason
std::size_t takeGains(PixelSums* sums, const double* reference_value, std::size_t pixels,
                      const WindowClock& clock, float* gain);

}  // namespace fast_edi
