/// \file
/// What the filters know of the events in a frame's exposure, beside the gains that follow from
/// them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast_edi/base/contrast_threshold.hpp"

namespace fast_edi {

struct ExposureEvents {
  const std::uint16_t* counts = nullptr;  ///< OFF, ON of each pixel, row-major; see EventCounts
  ContrastThresholds thresholds;

  float off(std::size_t pixel) const { return static_cast<float>(counts[2 * pixel]); }
  float on(std::size_t pixel) const { return static_cast<float>(counts[2 * pixel + 1]); }
};

}  // namespace fast_edi
