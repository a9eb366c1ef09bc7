/// \file
/// The double integral as slowly and plainly as it can be written: the oracle of the accuracy
/// tests.
///
///     E(f) = 1/U * sum over the stretches of constant level of exp(level - level(f)) * dwell
///
/// (Pan et al., CVPR 2019; counter weighting: Lin et al., ICRA 2023.) Levels are counted as whole
/// ON and OFF events, so that no rounding gathers along a list; all sums are long double.
///
/// With the ramps of a LevelModel there are stretches along which the level goes linearly from l to
/// l + d, which count (exp(d) - 1) / d times the value at their beginning.
///
/// Clock. Time weighting: the sensor time, U = length of the window. Counter weighting: event
/// number i of the window (from 0) has clock i, the window reaches from 0 to U = number of events
/// in the window; without events E = 1.
///
/// Borders. The window is half open: an event at its start counts, one at its end does not. The
/// level at the reference time holds the events before it; an event exactly at the reference time
/// comes after it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/level_model.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi::testing {

/// One event of a pixel's list inside a window.
struct PixelEvent {
  std::int64_t t_ns = 0;
  std::int64_t counter = 0;  ///< events of the whole window before this one
  bool on = false;
  std::int64_t ramp_ns = 0;  ///< length of the ramp before it, which may begin before the window
};

/// The lists of all pixels over one window.
struct WindowLists {
  std::vector<std::vector<PixelEvent>> pixels;  ///< row-major
  std::int64_t event_count = 0;                 ///< events in the window
};

/// Sorts the events inside \p window into lists. Events outside the sensor are left out.
/// \pre times in \p events never decrease
WindowLists windowLists(SensorSize size, const std::vector<Event>& events,
                        const ExposureInterval& window, const LevelModel& level = {});

/// E(reference) of one pixel by direct sums over the dwell times of its levels.
/// \param fraction h of the level model
long double pixelDoubleIntegral(const std::vector<PixelEvent>& list, std::int64_t window_events,
                                const ContrastThresholds& thresholds, Weighting weighting,
                                const ExposureInterval& window, std::int64_t reference_ns,
                                double fraction = 0.0);

/// E(reference) of every pixel, row-major. \pre window.length() > 0; the staircase with counter
/// weighting
std::vector<double> referenceDoubleIntegral(SensorSize size, const std::vector<Event>& events,
                                            const ContrastThresholds& thresholds,
                                            Weighting weighting, const ExposureInterval& window,
                                            std::int64_t reference_ns,
                                            const LevelModel& level = {});

}  // namespace fast_edi::testing
