/// \file
/// Natural logarithm and exponential for whole images: branch-free, so that loops over them are
/// vectorised, and exact where it matters (log 1 = 0, exp 0 = 1: a pixel without events stays as it
/// is).
///
/// Polynomials and range reduction after Moshier's Cephes library (logf, expf). Errors, tested: log
/// within 2e-7 absolute or relative, exp within 2e-7 relative.
#pragma once

#include <cstdint>
#include <cstring>

namespace fast_edi {

namespace fast_log_detail {

inline std::int32_t bitsOf(float value) {
  std::int32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

inline float floatOf(std::int32_t bits) {
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

constexpr int kMantissaBits = 23;
/// What one more in the exponent adds to the bits. Multiplied, since a negative number must not be
/// shifted to the left.
constexpr std::int32_t kExponentUnit = 1 << kMantissaBits;
constexpr int kExponentBias = 127;
// ln 2 in two parts: the first has few digits, so that its product with a small integer is exact.
constexpr float kLn2High = 0.693359375F;
constexpr float kLn2Low = -2.12194440e-4F;

}  // namespace fast_log_detail

/// \pre \p x is a positive normal number
inline float fastLog(float x) {
  using namespace fast_log_detail;
  // x = m 2^e with m in [1/sqrt(2), sqrt(2))
  constexpr std::int32_t kSqrtHalfBits = 0x3f3504f3;
  const std::int32_t offset_bits = bitsOf(x) - kSqrtHalfBits;
  const std::int32_t exponent = offset_bits >> kMantissaBits;
  const float f = floatOf(bitsOf(x) - exponent * kExponentUnit) - 1.0F;
  const auto e = static_cast<float>(exponent);
  float p = 7.0376836292e-2F;
  p = p * f - 1.1514610310e-1F;
  p = p * f + 1.1676998740e-1F;
  p = p * f - 1.2420140846e-1F;
  p = p * f + 1.4249322787e-1F;
  p = p * f - 1.6668057665e-1F;
  p = p * f + 2.0000714765e-1F;
  p = p * f - 2.4999993993e-1F;
  p = p * f + 3.3333331174e-1F;
  const float f2 = f * f;
  return ((p * f * f2 + e * kLn2Low) - 0.5F * f2) + f + e * kLn2High;
}

/// \pre -80 <= x <= 80
inline float fastExp(float x) {
  using namespace fast_log_detail;
  constexpr float kLog2E = 1.44269504F;
  // Rounds by adding and taking away a number that leaves no room for a fraction.
  constexpr float kRounder = 12582912.0F;  // 1.5 * 2^23
  const float shifted = x * kLog2E + kRounder;
  const float n = shifted - kRounder;
  const float r = (x - n * kLn2High) - n * kLn2Low;
  float p = 1.9875691500e-4F;
  p = p * r + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  const float mantissa = (p * r * r + r) + 1.0F;
  const std::int32_t exponent = static_cast<std::int32_t>(n) + kExponentBias;
  return mantissa * floatOf(exponent << kMantissaBits);
}

}  // namespace fast_edi
