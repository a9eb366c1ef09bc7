/// \file
/// How well two frames and the events of and between their exposures say the same, for an assumed
/// position and length of the exposures.
///
/// With B the blurry frames, E their double integrals at the middle of the exposures and l the
/// change of level by the events between both middles,
///
///     log B2 - log B1 = m + r,    m = l + log E2 - log E1,
///
/// m being what the events predict, with the level between two events that level_model.hpp
/// describes. Holding the level of the event before (a staircase) would look like events that lag
/// behind the light by a millisecond or two, and like thresholds that are too large.
///
/// For the right exposures r is noise. Two measures:
///
/// - correlation of log B2 - log B1 with m over the pixels: needs no thresholds, reveals inverted
///   polarities by its sign; coarse;
/// - cost: mean of log(1 + (r / s)^2), s = 0.3: robust, sharp at the optimum.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "survey/timing_sample.hpp"

namespace fast_edi {

/// How an exposure follows from a frame's stamp: its middle is stamp + shift + part x length.
struct WindowModel {
  double shift_ns = 0.0;
  double part = 0.0;                ///< +0.5: stamps mean the start; -0.5: the end
  double length_ns = 0.0;           ///< > 0: the same for all frames, instead of their own
  double length_factor = 1.0;       ///< on the frames' own lengths
  bool length_of_previous = false;  ///< lengths are one frame late
};

/// The exposure in event time; empty when the frame's length is not known.
std::optional<ExposureInterval> modelledExposure(const SampledFrame& frame,
                                                 const WindowModel& model);

struct Consistency {
  double cost = 0.0;
  double correlation = 0.0;
};

/// Marks the informative pixels: an edge has passed (events of mostly one polarity) from
/// the first exposure to the second. Noise alone would not do.
void markInformative(TimingSample& sample, const ExposureInterval& interval);

class PairConsistency {
 public:
  explicit PairConsistency(SensorSize size);

  /// Empty where the sample does not cover the exposures.
  /// \pre the sample's events keep intervals
  std::optional<Consistency> measure(const TimingSample& sample, const WindowModel& model,
                                     ContrastThresholds thresholds);

 private:
  void addLevels(const PixelEventLists& events, const ExposureInterval& first,
                 const ExposureInterval& second, ContrastThresholds thresholds);

  SensorSize size_;
  DoubleIntegral integral_;
  std::vector<float> first_gain_;
  std::vector<float> second_gain_;
  std::vector<float> level_;  ///< l
};

}  // namespace fast_edi
