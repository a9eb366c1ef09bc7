#include "fast_edi/latent/latent_instants.hpp"

#include <algorithm>

#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {
namespace {

constexpr ParameterRange kFilmRateRange{
    "rate of latent images", "Hz", {0.0, static_cast<double>(kMaxLatentRate_hz)}};

/// The middles of \p count equal parts.
std::vector<std::int64_t> middles(const ExposureInterval& interval, std::int64_t count) {
  std::vector<std::int64_t> instants;
  for (std::int64_t i = 0; i < count; ++i) {
    instants.push_back(interval.start_ns + interval.length() * (2 * i + 1) / (2 * count));
  }
  return instants;
}

std::vector<std::int64_t> filmInstants(const ExposureInterval& interval, int rate_hz) {
  std::vector<std::int64_t> instants;
  std::int64_t number = firstFilmNumber(interval.start_ns, rate_hz);
  for (std::int64_t t_ns = filmInstant(number, rate_hz); t_ns < interval.end_ns;
       t_ns = filmInstant(++number, rate_hz)) {
    instants.push_back(t_ns);
  }
  return instants;
}

}  // namespace

void validate(const LatentSampling& sampling) {
  requireWithin(limits::kLatentImages, static_cast<double>(sampling.per_exposure));
  requireWithin(kFilmRateRange, static_cast<double>(sampling.rate_hz));
}

// Whole seconds apart: number * 1e9 would overflow after a fraction of the time since 1970.

std::int64_t filmInstant(std::int64_t number, int rate_hz) {
  const std::int64_t second = number / rate_hz;
  return second * kNanosecondsPerSecond + number % rate_hz * kNanosecondsPerSecond / rate_hz;
}

std::int64_t firstFilmNumber(std::int64_t t_ns, int rate_hz) {
  const std::int64_t second = t_ns / kNanosecondsPerSecond;
  std::int64_t number =
      second * rate_hz + t_ns % kNanosecondsPerSecond * rate_hz / kNanosecondsPerSecond;
  while (filmInstant(number, rate_hz) < t_ns) {
    ++number;
  }
  return number;
}

std::vector<std::int64_t> instantsWithin(const ExposureInterval& exposure,
                                         const LatentSampling& sampling) {
  return sampling.rate_hz > 0 ? filmInstants(exposure, sampling.rate_hz)
                              : middles(exposure, sampling.per_exposure);
}

std::vector<std::int64_t> instantsBetween(const ExposureInterval& gap, std::int64_t exposure_ns,
                                          const LatentSampling& sampling) {
  if (gap.length() <= 0) {
    return {};
  }
  if (sampling.rate_hz > 0) {
    return filmInstants(gap, sampling.rate_hz);
  }
  const std::int64_t as_dense =
      (2 * gap.length() * sampling.per_exposure + exposure_ns) / (2 * exposure_ns);
  return middles(gap, std::min<std::int64_t>(as_dense, sampling.per_exposure));
}

}  // namespace fast_edi
