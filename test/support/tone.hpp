/// \file
/// Latent grey level of a pixel for the baselines: linear response without offset.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fast_edi::testing {

/// B / E, rounded to nearest and clamped to 8 bit.
inline std::uint8_t latentGrey(std::uint8_t blurry, double double_integral) {
  return static_cast<std::uint8_t>(std::min(255.0, blurry / double_integral + 0.5));
}

}  // namespace fast_edi::testing
