/// \file
/// At which instants a high-rate video shows latent images.
#pragma once

#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Either a number of images for each exposure, or a fixed rate; the rate wins. Off when both are
/// 0.
struct LatentSampling {
  int per_exposure = 0;
  int rate_hz = 0;  ///< at whole multiples of 1 / rate since the epoch, see filmInstant()

  bool isOn() const { return per_exposure > 0 || rate_hz > 0; }
};

constexpr int kMaxLatentRate_hz = 100'000;  ///< images of a second of recording

/// \throws std::invalid_argument naming the parameter, its value and what was expected
void validate(const LatentSampling& sampling);

/// The instant of image \p number of a film with \p rate_hz images a second: number / rate, rounded
/// down to nanoseconds.
std::int64_t filmInstant(std::int64_t number, int rate_hz);
/// The first number whose instant is not before \p t_ns.
std::int64_t firstFilmNumber(std::int64_t t_ns, int rate_hz);

// Intervals are no longer than some seconds below.

/// Instants within an exposure, in order: the middles of per_exposure equal parts, or those of the
/// film within [start, end).
std::vector<std::int64_t> instantsWithin(const ExposureInterval& exposure,
                                         const LatentSampling& sampling);

/// Instants in the gap [gap.start, gap.end) between two exposures, in order: the middles of equal
/// parts about as long as those of the exposure after it, but no more than per_exposure of them,
/// so that a short exposure does not cause a flood of images; or those of the film.
/// \param exposure_ns length of the exposure after the gap
std::vector<std::int64_t> instantsBetween(const ExposureInterval& gap, std::int64_t exposure_ns,
                                          const LatentSampling& sampling);

}  // namespace fast_edi
