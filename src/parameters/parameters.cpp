#include "fast_edi/parameters/parameters.hpp"

#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {

void validate(const ContrastThresholds& thresholds) {
  requireWithin(limits::kContrastOn, thresholds.on);
  requireWithin(limits::kContrastOff, thresholds.off);
}

LevelModel levelModel(const DeblurParameters& parameters) {
  const bool has_ramps = parameters.filter.enabled && parameters.weighting == Weighting::kTime;
  return has_ramps ? parameters.level : LevelModel{};
}

void validate(const DeblurParameters& parameters) {
  constexpr std::int64_t kUs = kNanosecondsPerMicrosecond;
  constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
  validate(parameters.thresholds);
  requireWithin(limits::kExposureTime, parameters.exposure_time_ns, kUs);
  requireWithin(limits::kTimeOffset, parameters.time_offset_ns, kUs);
  requireWithin(limits::kEventDelay, parameters.event_delay_ns, kUs);
  requireWithin(limits::kCloseTimeout, parameters.close_timeout_ns, kMs);
  requireWithin(limits::kBackwardJump, parameters.max_backward_jump_ns, kMs);
  requireWithin(limits::kForwardJump, parameters.max_forward_jump_ns, kMs);
  requireWithin(limits::kBufferedEvents, static_cast<double>(parameters.max_buffered_events));
  requireWithin(limits::kLevelRamp, parameters.level.ramp_ns, kMs);
  requireWithin(limits::kLevelRampFraction, parameters.level.fraction);
  validate(parameters.latent);
  validate(parameters.filter);
}

}  // namespace fast_edi
