/// \file
/// Everything a user can set about deblurring, in the units of the core. Names and defaults of the
/// user-facing keys are in parameters_from_yaml.hpp and cfg/README.md, ranges in
/// parameter_ranges.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/level_model.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_mapping.hpp"
#include "fast_edi/filters/filter_parameters.hpp"
#include "fast_edi/latent/camera_response.hpp"
#include "fast_edi/latent/latent_instants.hpp"

namespace fast_edi {

/// Where the length of the exposure comes from.
enum class ExposureSource { kTopic, kParameter };

struct DeblurParameters {
  ContrastThresholds thresholds;  ///< natural log
  Weighting weighting = Weighting::kTime;
  ExposureInstant reference = ExposureInstant::kMid;        ///< instant the latent image shows
  ExposureInstant stamp_reference = ExposureInstant::kMid;  ///< instant the input stamp means
  ExposureSource exposure_source = ExposureSource::kTopic;
  std::int64_t exposure_time_ns = 0;  ///< 0 = not known
  std::int64_t time_offset_ns = 0;    ///< event time = frame time + offset
  std::int64_t event_delay_ns = 0;    ///< of events behind the light; where learning starts
  std::int64_t close_timeout_ns = 100 * kNanosecondsPerMillisecond;
  EventMapping event_mapping;  ///< of the events to the frames' pixels and polarity
  std::size_t max_buffered_events = 13'000'000;
  std::int64_t max_backward_jump_ns = 500 * kNanosecondsPerMillisecond;
  std::int64_t max_forward_jump_ns = 10'000 * kNanosecondsPerMillisecond;
  CameraResponse response = CameraResponse::linear();
  LatentSampling latent;                                   ///< of the high-rate video
  LevelModel level{4 * kNanosecondsPerMillisecond, 0.85};  ///< see levelModel()
  FilterParameters filter;
  bool refine_contrast = true;  ///< learn the thresholds from the recording; needs filter.enabled
  bool refine_delay = true;     ///< learn event_delay_ns from the recording; needs filter.enabled
  bool passthrough = false;     ///< publish every frame unchanged
};

/// Stamps are 32-bit seconds; with this limit no sum of stamp, offset and jump limit overflows.
constexpr std::int64_t kMaxTimeOffset_ns = 3'000'000'000 * kNanosecondsPerSecond;

/// The level model in force: the staircase with counter weighting and for plain EDI.
LevelModel levelModel(const DeblurParameters& parameters);

// Both against parameter_ranges.hpp. They throw std::invalid_argument naming the parameter, its
// value and what was expected.
void validate(const ContrastThresholds& thresholds);
void validate(const DeblurParameters& parameters);

}  // namespace fast_edi
