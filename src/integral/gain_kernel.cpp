#include "integral/gain_kernel.hpp"

#include <algorithm>

#include "base/vector_instructions.hpp"

#if FAST_EDI_SSE2
#include <emmintrin.h>
#endif

#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/integral/gain_limits.hpp"

namespace fast_edi {
namespace {

constexpr PixelSums kNoEvent{0.0, 1.0};

double integralOf(const PixelSums& pixel, const IntervalClock& clock) {
  return pixel.sum + pixel.value * clock.end - clock.start;
}

float gainOf(const PixelSums& before, const PixelSums& after, const IntervalClock& before_clock,
             const IntervalClock& after_clock) {
  const double length = before_clock.length() + after_clock.length();
  const double integral =
      integralOf(before, before_clock) + before.value * integralOf(after, after_clock);
  const double ratio = length * before.value / integral;
  // Both are false for NaN, which an infinite value leaves behind.
  if (!(integral > 0.0) || !(ratio >= 0.0)) {
    return kOutOfRange;
  }
  return static_cast<float>(std::min(std::max(ratio, kMinGain), kMaxGain));
}

#if FAST_EDI_SSE2

/// gainOf() for two pixels, in the lower two lanes; rounds alike.
class TwoPixelGain {
 public:
  TwoPixelGain(const IntervalClock& before, const IntervalClock& after)
      : before_start_(_mm_set1_pd(before.start)),
        before_end_(_mm_set1_pd(before.end)),
        after_start_(_mm_set1_pd(after.start)),
        after_end_(_mm_set1_pd(after.end)),
        length_(_mm_set1_pd(before.length() + after.length())) {}

  __m128 operator()(PixelSums* before, PixelSums* after) const {
    const Pair a = take(before);
    const Pair b = take(after);
    const __m128d integral_a =
        _mm_sub_pd(_mm_add_pd(a.sum, _mm_mul_pd(a.value, before_end_)), before_start_);
    const __m128d integral_b =
        _mm_sub_pd(_mm_add_pd(b.sum, _mm_mul_pd(b.value, after_end_)), after_start_);
    const __m128d integral = _mm_add_pd(integral_a, _mm_mul_pd(a.value, integral_b));
    const __m128d ratio = _mm_div_pd(_mm_mul_pd(length_, a.value), integral);
    const __m128d bounded = _mm_min_pd(_mm_max_pd(ratio, min_), max_);
    const __m128d known = _mm_and_pd(_mm_cmpgt_pd(integral, zero_), _mm_cmpge_pd(ratio, zero_));
    return _mm_cvtpd_ps(_mm_and_pd(known, bounded));
  }

 private:
  struct Pair {
    __m128d sum;
    __m128d value;
  };

  /// Loads the results of two pixels and resets them.
  Pair take(PixelSums* sums) const {
    const __m128d first = _mm_load_pd(&sums[0].sum);
    const __m128d second = _mm_load_pd(&sums[1].sum);
    _mm_store_pd(&sums[0].sum, no_event_);
    _mm_store_pd(&sums[1].sum, no_event_);
    return {_mm_unpacklo_pd(first, second), _mm_unpackhi_pd(first, second)};
  }

  __m128d before_start_;
  __m128d before_end_;
  __m128d after_start_;
  __m128d after_end_;
  __m128d length_;
  __m128d zero_ = _mm_setzero_pd();
  __m128d min_ = _mm_set1_pd(kMinGain);
  __m128d max_ = _mm_set1_pd(kMaxGain);
  __m128d no_event_ = _mm_set_pd(kNoEvent.value, kNoEvent.sum);
};

#endif

}  // namespace

void takeGains(const IntervalSums& before, const IntervalSums& after, std::size_t pixels,
               float* gain) {
  std::size_t i = 0;
#if FAST_EDI_SSE2
  const TwoPixelGain two(before.clock, after.clock);
  constexpr std::size_t kStride = 4;
  for (; i + kStride <= pixels; i += kStride) {
    const __m128 low = two(before.sums + i, after.sums + i);
    const __m128 high = two(before.sums + i + 2, after.sums + i + 2);
    _mm_storeu_ps(gain + i, _mm_movelh_ps(low, high));
  }
#endif
  for (; i < pixels; ++i) {
    gain[i] = gainOf(before.sums[i], after.sums[i], before.clock, after.clock);
    before.sums[i] = kNoEvent;
    after.sums[i] = kNoEvent;
  }
}

std::size_t replaceOutOfRange(std::size_t pixels, float* gain) {
  const auto out_of_range = static_cast<std::size_t>(std::count(gain, gain + pixels, kOutOfRange));
  if (out_of_range > 0) {
    std::replace(gain, gain + pixels, kOutOfRange, 1.0f);
  }
  return out_of_range;
}

}  // namespace fast_edi
