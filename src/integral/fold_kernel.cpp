#include "integral/fold_kernel.hpp"

#include <cstdlib>
#include <limits>

#include "base/vector_instructions.hpp"

#if FAST_EDI_SSE2
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

inline void foldOneRamp(std::uint32_t code, double clock, std::uint16_t ticks,
                        const EventFactors& factors, PixelSums* sums) {
  PixelSums& pixel = sums[code >> 1];
  const double k = factors.one_minus[code & 1u];
  const auto ramp = static_cast<double>(ticks < factors.most_ticks ? ticks : factors.most_ticks);
  pixel.sum += pixel.value * (k * clock + factors.excess[code & 1u] * ramp);
  pixel.value -= pixel.value * k;
}

#if FAST_EDI_SSE2

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
        most_ticks_(_mm_set1_epi16(static_cast<std::int16_t>(factors.most_ticks))),
        excess_off_(_mm_set1_pd(factors.excess[0])),
        excess_on_xor_off_(_mm_xor_pd(_mm_set1_pd(factors.excess[1]), excess_off_)),
        sums_(sums) {}

  void operator()(const PackedEvent* events) const {
    const Pair first = prepare(events);
    const Pair second = prepare(events + 2);
    fold(events[0].code, _mm_unpacklo_pd(first.k_clock, first.minus_k));
    fold(events[1].code, _mm_unpackhi_pd(first.k_clock, first.minus_k));
    fold(events[2].code, _mm_unpacklo_pd(second.k_clock, second.minus_k));
    fold(events[3].code, _mm_unpackhi_pd(second.k_clock, second.minus_k));
  }

  /// The same with ramps.
  void operator()(const PackedEvent* events, const std::uint16_t* intervals) const {
    const __m128i all = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(intervals));
    const __m128i within = _mm_sub_epi16(all, _mm_subs_epu16(all, most_ticks_));
    const __m128i ticks = _mm_unpacklo_epi16(within, _mm_setzero_si128());
    const Pair first = prepare(events, ticks);
    const Pair second = prepare(events + 2, _mm_unpackhi_epi64(ticks, ticks));
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
    const __m128d k = byPolarity(packed, off_, on_xor_off_);
    return {_mm_mul_pd(k, clocks(packed)), _mm_xor_pd(k, _mm_set1_pd(-0.0))};
  }

  /// \param ticks of both ramps in the lower lanes
  Pair prepare(const PackedEvent* events, __m128i ticks) const {
    const __m128i packed = _mm_loadu_si128(reinterpret_cast<const __m128i*>(events));
    const __m128d k = byPolarity(packed, off_, on_xor_off_);
    const __m128d ramp =
        _mm_mul_pd(byPolarity(packed, excess_off_, excess_on_xor_off_), _mm_cvtepi32_pd(ticks));
    return {_mm_add_pd(_mm_mul_pd(k, clocks(packed)), ramp), _mm_xor_pd(k, _mm_set1_pd(-0.0))};
  }

  __m128d clocks(__m128i packed) const {
    const __m128i dt = _mm_shuffle_epi32(packed, _MM_SHUFFLE(0, 0, 2, 0));
    return _mm_cvtepi32_pd(_mm_add_epi32(dt, offset_));
  }

  static __m128d byPolarity(__m128i packed, __m128d off, __m128d on_xor_off) {
    const __m128i codes = _mm_shuffle_epi32(packed, _MM_SHUFFLE(3, 3, 1, 1));
    const __m128i on = _mm_srai_epi32(_mm_slli_epi32(codes, 31), 31);
    return _mm_xor_pd(off, _mm_and_pd(_mm_castsi128_pd(on), on_xor_off));
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
  __m128i most_ticks_;
  __m128d excess_off_;
  __m128d excess_on_xor_off_;
  PixelSums* sums_;
};

/// Whether clocks fit 32 bits.
bool fitsStrides(const PackedEvent* events, std::size_t count, std::int64_t offset_ns) {
  constexpr std::int64_t kMaxClock = std::numeric_limits<std::int32_t>::max();
  return count >= kStride && offset_ns >= -kMaxClock &&
         offset_ns + static_cast<std::int64_t>(events[count - 1].dt_ns) <= kMaxClock;
}

/// Folds most of the events; returns how many. Clocks must fit 32 bits, dt_ns 31.
std::size_t foldStrides(const PackedEvent* events, std::size_t count, std::int64_t offset_ns,
                        const EventFactors& factors, PixelSums* sums) {
  if (!fitsStrides(events, count, offset_ns)) {
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

/// The same with ramps.
std::size_t foldRampStrides(const PackedEvent* events, const std::uint16_t* intervals,
                            std::size_t count, std::int64_t offset_ns, const EventFactors& factors,
                            PixelSums* sums) {
  if (!fitsStrides(events, count, offset_ns)) {
    return 0;
  }
  const FourEventFolder fold(static_cast<std::int32_t>(offset_ns), factors, sums);
  std::size_t i = 0;
  for (; i + kPrefetchDistance + kStride <= count; i += kStride) {
    fold.prefetch(events + i + kPrefetchDistance);
    fold(events + i, intervals + i);
  }
  for (; i + kStride <= count; i += kStride) {
    fold(events + i, intervals + i);
  }
  return i;
}

#else

std::size_t foldStrides(const PackedEvent*, std::size_t, std::int64_t, const EventFactors&,
                        PixelSums*) {
  return 0;
}

std::size_t foldRampStrides(const PackedEvent*, const std::uint16_t*, std::size_t, std::int64_t,
                            const EventFactors&, PixelSums*) {
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

void foldRampsByTime(const PackedEvent* events, const std::uint16_t* intervals, std::size_t count,
                     std::int64_t offset_ns, const EventFactors& factors, PixelSums* sums) {
  std::size_t i = foldRampStrides(events, intervals, count, offset_ns, factors, sums);
  for (; i < count; ++i) {
    foldOneRamp(events[i].code,
                static_cast<double>(static_cast<std::int64_t>(events[i].dt_ns) + offset_ns),
                intervals[i], factors, sums);
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
