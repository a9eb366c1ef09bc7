#include "fold_kernel.hpp"

#include <cstdlib>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace fast_edi {
namespace {

inline void foldOne(std::uint32_t code, double clock, const EventFactors& factors,
                    PixelSums* sums) {
  PixelSums& pixel = sums[code >> 1];
  const double k = factors.one_minus[code & 1u];
  pixel.sum += pixel.value * (k * clock);
  pixel.value -= pixel.value * k;
}

#if defined(__SSE2__)

constexpr std::size_t kStride = 4;
/// Events between a prefetch and its use: covers the latency of the second-level cache.
constexpr std::size_t kPrefetchDistance = 16;

/// Four events: clocks and factors for all at once, then pixel after pixel.
class FourEventFolder {
 public:
  FourEventFolder(std::int32_t offset_ns, const EventFactors& factors, PixelSums* sums)
      : offset_(_mm_set1_epi32(offset_ns)),
        off_(_mm_set1_pd(factors.one_minus[0])),
        on_xor_off_(_mm_xor_pd(_mm_set1_pd(factors.one_minus[1]), off_)),
        sums_(sums) {}

  void operator()(const PackedEvent* events) const {
    const Pair first = prepare(events);
    const Pair second = prepare(events + 2);
    fold(events[0].code, _mm_unpacklo_pd(first.k_clock, first.minus_k));
    fold(events[1].code, _mm_unpackhi_pd(first.k_clock, first.minus_k));
    fold(events[2].code, _mm_unpacklo_pd(second.k_clock, second.minus_k));
    fold(events[3].code, _mm_unpackhi_pd(second.k_clock, second.minus_k));
  }

  void prefetch(const PackedEvent* events) const {
    for (std::size_t i = 0; i < kStride; ++i) {
      __builtin_prefetch(sums_ + (events[i].code >> 1), 1);
    }
  }

 private:
  struct Pair {
    __m128d k_clock;
    __m128d minus_k;
  };

  Pair prepare(const PackedEvent* events) const {
    const __m128i packed = _mm_loadu_si128(reinterpret_cast<const __m128i*>(events));
    const __m128i dt = _mm_shuffle_epi32(packed, _MM_SHUFFLE(0, 0, 2, 0));
    const __m128d clock = _mm_cvtepi32_pd(_mm_add_epi32(dt, offset_));
    const __m128i codes = _mm_shuffle_epi32(packed, _MM_SHUFFLE(3, 3, 1, 1));
    const __m128i on = _mm_srai_epi32(_mm_slli_epi32(codes, 31), 31);
    const __m128d k = _mm_xor_pd(off_, _mm_and_pd(_mm_castsi128_pd(on), on_xor_off_));
    return {_mm_mul_pd(k, clock), _mm_xor_pd(k, _mm_set1_pd(-0.0))};
  }

  void fold(std::uint32_t code, __m128d factor) const {
    double* pixel = &sums_[code >> 1].sum;
    const __m128d state = _mm_load_pd(pixel);
    const __m128d value = _mm_unpackhi_pd(state, state);
    _mm_store_pd(pixel, _mm_add_pd(state, _mm_mul_pd(value, factor)));
  }

  __m128i offset_;
  __m128d off_;
  __m128d on_xor_off_;
  PixelSums* sums_;
};

/// Folds most of the events; returns how many. Clocks must fit 32 bits, dt_ns 31.
std::size_t foldStrides(const PackedEvent* events, std::size_t count, std::int64_t offset_ns,
                        const EventFactors& factors, PixelSums* sums) {
  constexpr std::int64_t kMaxClock = std::numeric_limits<std::int32_t>::max();
  if (count < kStride || offset_ns < -kMaxClock ||
      offset_ns + static_cast<std::int64_t>(events[count - 1].dt_ns) > kMaxClock) {
    return 0;
  }
  const FourEventFolder fold(static_cast<std::int32_t>(offset_ns), factors, sums);
  std::size_t i = 0;
  for (; i + kPrefetchDistance + kStride <= count; i += kStride) {
    fold.prefetch(events + i + kPrefetchDistance);
    fold(events + i);
  }
  for (; i + kStride <= count; i += kStride) {
    fold(events + i);
  }
  return i;
}

#else

std::size_t foldStrides(const PackedEvent*, std::size_t, std::int64_t, const EventFactors&,
                        PixelSums*) {
  return 0;
}

#endif

}  // namespace

void foldByTime(const PackedEvent* events, std::size_t count, std::int64_t offset_ns,
                const EventFactors& factors, PixelSums* sums) {
  for (std::size_t i = foldStrides(events, count, offset_ns, factors, sums); i < count; ++i) {
    foldOne(events[i].code,
            static_cast<double>(static_cast<std::int64_t>(events[i].dt_ns) + offset_ns), factors,
            sums);
  }
}

void foldByCounter(const PackedEvent* events, std::size_t count, std::int64_t first_clock,
                   const EventFactors& factors, PixelSums* sums) {
  for (std::size_t i = 0; i < count; ++i) {
    foldOne(events[i].code, static_cast<double>(first_clock + static_cast<std::int64_t>(i)),
            factors, sums);
  }
}

}  // namespace fast_edi
