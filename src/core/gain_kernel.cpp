#include "gain_kernel.hpp"

#include <algorithm>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "fast_edi/core/double_integral.hpp"

namespace fast_edi {
namespace {

constexpr PixelSums kNoEvent{0.0, 1.0};

/// Stands for a gain that cannot be computed; no other gain is below kMinGain.
constexpr float kOutOfRange = 0.0f;

float gainOf(const PixelSums& pixel, double reference_value, const WindowClock& clock) {
  const double integral = pixel.sum + pixel.value * clock.end - clock.start;
  const double ratio = (clock.end - clock.start) * reference_value / integral;
  // Both are false for NaN, which an infinite value leaves behind.
  if (!(integral > 0.0) || !(ratio >= 0.0)) {
    return kOutOfRange;
  }
  return static_cast<float>(
      std::min(std::max(ratio, DoubleIntegral::kMinGain), DoubleIntegral::kMaxGain));
}

#if defined(__SSE2__)

/// gainOf() for two pixels, in the lower two lanes; rounds alike.
class TwoPixelGain {
 public:
  explicit TwoPixelGain(const WindowClock& clock)
      : start_(_mm_set1_pd(clock.start)),
        end_(_mm_set1_pd(clock.end)),
        length_(_mm_set1_pd(clock.end - clock.start)) {}

  __m128 operator()(PixelSums* sums, const double* reference_value) const {
    const __m128d first = _mm_load_pd(&sums[0].sum);
    const __m128d second = _mm_load_pd(&sums[1].sum);
    _mm_store_pd(&sums[0].sum, no_event_);
    _mm_store_pd(&sums[1].sum, no_event_);
    const __m128d sum = _mm_unpacklo_pd(first, second);
    const __m128d value = _mm_unpackhi_pd(first, second);
    const __m128d integral = _mm_sub_pd(_mm_add_pd(sum, _mm_mul_pd(value, end_)), start_);
    const __m128d ratio = _mm_div_pd(_mm_mul_pd(length_, _mm_loadu_pd(reference_value)), integral);
    const __m128d bounded = _mm_min_pd(_mm_max_pd(ratio, min_), max_);
    const __m128d known = _mm_and_pd(_mm_cmpgt_pd(integral, zero_), _mm_cmpge_pd(ratio, zero_));
    return _mm_cvtpd_ps(_mm_and_pd(known, bounded));
  }

 private:
  __m128d start_;
  __m128d end_;
  __m128d length_;
  __m128d zero_ = _mm_setzero_pd();
  __m128d min_ = _mm_set1_pd(DoubleIntegral::kMinGain);
  __m128d max_ = _mm_set1_pd(DoubleIntegral::kMaxGain);
  __m128d no_event_ = _mm_set_pd(kNoEvent.value, kNoEvent.sum);
};

#endif

}  // namespace

std::size_t takeGains(PixelSums* sums, const double* reference_value, std::size_t pixels,
                      const WindowClock& clock, float* gain) {
  std::size_t i = 0;
#if defined(__SSE2__)
  const TwoPixelGain two(clock);
  constexpr std::size_t kStride = 4;
  for (; i + kStride <= pixels; i += kStride) {
    const __m128 low = two(sums + i, reference_value + i);
    const __m128 high = two(sums + i + 2, reference_value + i + 2);
    _mm_storeu_ps(gain + i, _mm_movelh_ps(low, high));
  }
#endif
  for (; i < pixels; ++i) {
    gain[i] = gainOf(sums[i], reference_value[i], clock);
    sums[i] = kNoEvent;
  }
  const auto out_of_range = static_cast<std::size_t>(std::count(gain, gain + pixels, kOutOfRange));
  if (out_of_range > 0) {
    std::replace(gain, gain + pixels, kOutOfRange, 1.0f);
  }
  return out_of_range;
}

}  // namespace fast_edi
