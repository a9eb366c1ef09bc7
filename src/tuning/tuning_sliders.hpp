/// \file
/// The parameters that can be judged by eye, as sliders.
#pragma once

#include <cstdint>
#include <vector>

#include "tuning/slider.hpp"

namespace fast_edi {

/// What a recording says about the sliders' ranges.
struct TuningRanges {
  bool exposures_known = false;          ///< frames have exposures of their own: no slider for it
  std::int64_t longest_exposure_us = 0;  ///< where they have none; 0: up to the parameter's limit
  double time_offset_us = 0.0;           ///< where the tuning starts
};

/// The time offset can be moved this far, to both sides.
constexpr std::int64_t kOffsetRange_us = 50'000;

/// Contrast thresholds, exposure, time offset, and the strengths of filters. Ranges are those of
/// parameterDescriptions(), as far as \p ranges leaves them.
std::vector<Slider> tuningSliders(const TuningRanges& ranges);

}  // namespace fast_edi
