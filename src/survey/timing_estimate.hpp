/// \file
/// Where the exposures lie, from frames and events alone: meaning of the stamps, offset of the
/// clocks, length of the exposure and, on the way, contrast thresholds.
///
/// Search: by correlation over a wide range of shifts and, if need be, over orientations and
/// polarity of the events (coarse_match.hpp), then by cost (pair_consistency.hpp) over
/// shift, thresholds and, where it is not known, length. Uncertainty: bootstrap over the samples.
///
/// The shift contains the delay of the pixels' photoreceptors, which is half a millisecond in
/// bright and some milliseconds in dim light: events cannot distinguish it from an offset of the
/// clocks.
///
/// With equal exposure times only the shift of the exposures' middles against the stamps can be
/// seen: a stamp at the start looks like an offset of half an exposure. Where lengths vary by more
/// than some percent, the part of the length that the shift contains shows what stamps mean.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "survey/coarse_match.hpp"
#include "survey/timing_sample.hpp"

namespace fast_edi {

struct TimingSearch {
  ContrastThresholds thresholds{0.25, 0.25};  ///< to begin with
  std::int64_t centre_ns = 0;                 ///< shifts are looked for around this ...
  std::int64_t range_ns = 0;                  ///< ... up to this far
  std::function<void(int done, int total)> progress;
};

struct TimingEstimate {
  bool told = false;
  std::string reason;  ///< why there is no estimate
  std::size_t samples = 0;
  double correlation = 0.0;  ///< of what frames and events say, at the best shift

  EventMapping
      mapping;  ///< what fits events to frames; what follows is for events mapped like this
  double shift_ns = 0.0;  ///< middle of the exposure - stamp, in event time
  double shift_sigma_ns = 0.0;
  double length_ns = 0.0;  ///< mean, as known or as found

  /// Lengths vary enough to find what stamps mean; then offset_ns is what is left.
  std::optional<ExposureInstant> reference;
  double offset_ns = 0.0;
  bool lengths_one_late = false;  ///< each length belongs to the frame before

  /// Length found / length known; or, where it was not known, 1.
  double length_factor = 1.0;
  double length_sigma = 0.0;  ///< relative
  bool length_told = false;
  ContrastThresholds thresholds;
  ContrastThresholds threshold_sigmas{1.0, 1.0};  ///< relative

  bool frames_stretched = false;  ///< areStretched(): thresholds are not those of the sensor

  std::vector<ShiftPoint> curve;  ///< for a picture
};

/// \param samples are turned to the mapping that is found
/// \param grid TimingSampler::grid()
TimingEstimate estimateTiming(std::vector<TimingSample>& samples, const SampleGrid& grid,
                              const TimingSearch& search);

}  // namespace fast_edi
