/// \file
/// The level between events: how a pixel's log intensity is assumed to change until the next event.
///
/// An event says that the log intensity has *reached* a step; before it, it moved there. With t_k
/// and s_k the times and steps (+c_on, -c_off) of a pixel's events, the log intensity relative to
/// the reference time f is
///
///     log L(t) - log L(f) = sum_k s_k (rho_k(t) - rho_k(f)),
///
///     rho_k(t) = 1                                  for t > t_k
///              = h max(0, 1 - (t_k - t) / r_k)      for t <= t_k,     r_k = min(t_k - t_{k-1},
///              tau)
///
/// that is: during r_k before its event the level goes linearly by the fraction h of the step, the
/// rest at the event. With tau = 0 or h = 0 it is the staircase of Pan et al. (CVPR 2019), which
/// lags behind the light by half a step on average. A ramp over the whole time between two events
/// would be wrong the other way: an edge passes quickly, and then the level stays.
///
/// All stages use this model: DoubleIntegral, LatentGains,
/// OnlineCalibration, PairConsistency. Two conventions make it a function of the event stream
/// alone, so that an image does not depend on packets or on when its frame was closed:
/// - r_k counts in ticks (PixelEventLists keeps them with each event, also for the first events of
///   an exposure): whole ticks, less one, so that no ramp begins before the event that it follows.
/// - Events at or after the end of what a stage looks at are not known yet, and have no ramp there.
///
/// Over a whole ramp the mean of the latent value is K times the one before it,
/// K = (exp(h s) - 1) / (h s).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Unit in which times between events of a pixel are kept [ns].
constexpr std::int64_t kIntervalTick_ns = 256;
/// Longer intervals are kept as this many ticks: 16.8 ms.
constexpr std::int64_t kMostIntervalTicks = UINT16_MAX;
constexpr std::int64_t kLongestRamp_ns = kMostIntervalTicks * kIntervalTick_ns;

/// An instant, and up to when events are known there: those from then on have no ramps yet.
struct LevelInstant {
  std::int64_t t_ns = 0;
  std::int64_t known_until_ns = 0;  ///< not before t_ns
};

struct LevelModel {
  std::int64_t ramp_ns = 0;  ///< tau, at most kLongestRamp_ns
  double fraction = 0.0;     ///< h, 0 to 1

  bool isStaircase() const { return ramp_ns < kIntervalTick_ns || fraction <= 0.0; }

  /// tau in whole ticks.
  std::uint16_t mostTicks() const {
    return static_cast<std::uint16_t>(
        std::clamp<std::int64_t>(ramp_ns / kIntervalTick_ns, 0, kMostIntervalTicks));
  }
  /// r_k of an event \p interval_ticks after the one before it [ns].
  std::int64_t rampBefore(std::uint16_t interval_ticks) const {
    return std::min(interval_ticks, mostTicks()) * kIntervalTick_ns;
  }
  /// rho_k at \p ahead_ns before the event (< 0: after it).
  double reached(std::int64_t ahead_ns, std::uint16_t interval_ticks) const {
    if (ahead_ns < 0) {
      return 1.0;
    }
    const std::int64_t ramp = rampBefore(interval_ticks);
    return ramp > ahead_ns
               ? fraction * static_cast<double>(ramp - ahead_ns) / static_cast<double>(ramp)
               : 0.0;
  }
  /// rho_k of an event at \p event_ns, as far as it is known.
  double reached(std::int64_t event_ns, std::uint16_t interval_ticks,
                 const LevelInstant& at) const {
    return event_ns < at.known_until_ns ? reached(event_ns - at.t_ns, interval_ticks) : 0.0;
  }
  /// K - 1 of a ramp that rises by h s [natural log].
  static double excess(double rise) {
    if (std::abs(rise) > kSeriesReach) {
      return std::expm1(rise) / rise - 1.0;
    }
    // Without cancellation, and quicker: rise / 2! + rise^2 / 3! + ...
    double sum = 0.0;
    for (const double coefficient : kInverseFactorials) {
      sum = (coefficient + sum) * rise;
    }
    return sum;
  }

  friend bool operator==(const LevelModel& a, const LevelModel& b) {
    return a.ramp_ns == b.ramp_ns && a.fraction == b.fraction;
  }
  friend bool operator!=(const LevelModel& a, const LevelModel& b) { return !(a == b); }

 private:
  static constexpr double kSeriesReach = 0.5;
  /// 1 / 11!, ..., 1 / 2!; what follows is below 1e-11.
  static constexpr double kInverseFactorials[] = {
      1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0,
      1.0 / 720.0,      1.0 / 120.0,     1.0 / 24.0,     1.0 / 6.0,     1.0 / 2.0};
};

}  // namespace fast_edi
