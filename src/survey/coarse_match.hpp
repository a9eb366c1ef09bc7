/// \file
/// Where frames and events fit at all: a wide search over the shift of the exposures and, where
/// they fit nowhere, over the eight orientations that events can have against the frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/events/event_mapping.hpp"
#include "survey/pair_consistency.hpp"
#include "survey/timing_sample.hpp"

namespace fast_edi {

/// One shift of the exposures' middles against the stamps, with what it gives on average.
struct ShiftPoint {
  double shift_ns = 0.0;
  double cost = 0.0;
  double correlation = 0.0;
};

/// Shifts that are tried.
struct ShiftRange {
  double centre_ns = 0.0;
  double range_ns = 0.0;  ///< to either side
  double step_ns = 0.0;
};

struct CoarseMatch {
  /// Correlation less than this is chance.
  static constexpr double kLeastCorrelation = 0.3;

  EventMapping mapping;      ///< of the events, to fit the frames
  double correlation = 0.0;  ///< at the best shift, negative where polarities are exchanged
  double shift_ns = 0.0;
  std::vector<ShiftPoint> curve;

  bool fits() const { return correlation > kLeastCorrelation || correlation < -kLeastCorrelation; }
};

/// \param model, thresholds of the windows; its shift is replaced
/// \param samples every stride-th is used
CoarseMatch matchShifts(const std::vector<TimingSample>& samples, std::size_t stride,
                        const WindowModel& model, ContrastThresholds thresholds,
                        const ShiftRange& shifts, PairConsistency& consistency);

/// The best of all orientations; samples are left as readExposure() of that one makes them, and
/// with ON and OFF exchanged where they have to be. The orientation as recorded is kept unless it
/// fits nowhere and another one does.
CoarseMatch matchOrientations(std::vector<TimingSample>& samples, const SampleGrid& grid,
                              const WindowModel& model, ContrastThresholds thresholds,
                              const ShiftRange& shifts, PairConsistency& consistency);

}  // namespace fast_edi
