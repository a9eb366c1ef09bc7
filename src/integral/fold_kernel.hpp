/// \file
/// The innermost loop: what an event does to its pixel's running result.
///
///     sum <- sum + v (k u),   v <- v - v k,   k = 1 - m
///
/// with m the event's multiplier and u its clock; with the ramps of LevelModel
///
///     sum <- sum + v (k u + (K - 1) r)
///
/// since over the ramp of length r the value is K v in the mean instead of v. All paths below round
/// alike, so which one runs cannot be seen in the result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

/// Running result of one pixel. Aligned so that both halves load and store as one.
struct alignas(16) PixelSums {
  double sum;    ///< sum_k v_{k-1} (1 - m_k) u_k over the events folded in
  double value;  ///< v after them
};

/// An event's effect by polarity (0 = OFF, 1 = ON).
struct EventFactors {
  double multiplier[2];      ///< m = exp(step)
  double one_minus[2];       ///< k = 1 - m
  double excess[2];          ///< (K - 1) kIntervalTick_ns; 0 for the staircase
  std::uint16_t most_ticks;  ///< of a ramp; 0 for the staircase
};

/// Folds in events whose clock is their time: u = dt_ns + offset_ns.
void foldByTime(const PackedEvent* events, std::size_t count, std::int64_t offset_ns,
                const EventFactors& factors, PixelSums* sums);

/// The same with ramps. \param intervals of the events, see EventIntervals
void foldRampsByTime(const PackedEvent* events, const std::uint16_t* intervals, std::size_t count,
                     std::int64_t offset_ns, const EventFactors& factors, PixelSums* sums);

/// Folds in events whose clock is their place: u = first_clock, first_clock + 1, ...
void foldByCounter(const PackedEvent* events, std::size_t count, std::int64_t first_clock,
                   const EventFactors& factors, PixelSums* sums);

}  // namespace fast_edi
