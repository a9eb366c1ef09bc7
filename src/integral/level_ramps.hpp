/// \file
/// The ramps of LevelModel that an instant falls into.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/level_model.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

/// A ramp on its way.
struct OpenRamp {
  std::size_t pixel;
  bool on;                ///< polarity of its event
  std::int64_t event_ns;  ///< time of its event
  double done_ns;         ///< of its length, before the instant; above 0
  double done;            ///< the same as a fraction of its length
};

/// Calls \p visit with the OpenRamp of each pixel whose next event has begun its ramp before
/// \p t_ns; at most one for a pixel, since no ramp begins before the event that it follows.
/// \param until_ns events from here on are not known
/// \return events walked
/// \pre the lists keep intervals unless \p level is the staircase
template <typename Visit>
std::uint64_t visitOpenRamps(const PixelEventLists& lists, std::int64_t t_ns, std::int64_t until_ns,
                             const LevelModel& level, Visit visit) {
  if (level.isStaircase() || until_ns <= t_ns) {
    return 0;
  }
  const std::uint16_t most_ticks = level.mostTicks();
  const std::uint64_t begin = lists.lowerBound(t_ns);
  const std::uint64_t end =
      lists.lowerBound(std::min(until_ns, t_ns + most_ticks * kIntervalTick_ns));
  for (std::uint64_t next = begin; next < end;) {
    const PackedEventSpan span = lists.span(next, end);
    const std::int64_t offset_ns = span.base_ns - t_ns;
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::int64_t ahead_ns = static_cast<std::int64_t>(span.data[i].dt_ns) + offset_ns;
      const std::int64_t ramp_ns = std::min(span.intervals[i], most_ticks) * kIntervalTick_ns;
      if (ramp_ns > ahead_ns) {
        const auto done_ns = static_cast<double>(ramp_ns - ahead_ns);
        visit(OpenRamp{span.data[i].code >> 1, (span.data[i].code & 1u) != 0, t_ns + ahead_ns,
                       done_ns, done_ns / static_cast<double>(ramp_ns)});
      }
    }
    next += span.count;
  }
  return end - begin;
}

/// What level_model.hpp calls h s, by polarity (0 = OFF, 1 = ON).
struct RampRises {
  RampRises(const LevelModel& level, const ContrastThresholds& thresholds)
      : rise{level.fraction * thresholds.step(false), level.fraction * thresholds.step(true)} {}

  /// Latent value at the instant relative to that before the ramp.
  float value(const OpenRamp& ramp) const {
    return std::exp(static_cast<float>(rise[ramp.on] * ramp.done));
  }
  /// Integral, up to the instant, of that value less one [ns].
  double excess(const OpenRamp& ramp) const {
    return ramp.done_ns * LevelModel::excess(rise[ramp.on] * ramp.done);
  }

  double rise[2];
};

}  // namespace fast_edi
