/// \file
/// A texture that moves evenly past the sensor: events and the frame that belongs to them, as
/// filter_reblur needs them. Noise of events at random would be left as it is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi::benchmarks {

struct MovingTexture {
  std::vector<Event> events;        ///< of one period of PeriodicStream, from time 0 on
  ContrastThresholds thresholds;    ///< for which there are that many
  std::vector<std::uint8_t> frame;  ///< of the exposure, with read noise
};

/// \param events_per_exposure about as many are made
/// \param path_px of the texture during the exposure
MovingTexture moveTexture(SensorSize size, std::size_t events_per_exposure, double path_px);

}  // namespace fast_edi::benchmarks
