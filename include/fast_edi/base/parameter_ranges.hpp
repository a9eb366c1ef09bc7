/// \file
/// Which numbers each parameter may be, in the units that people type. The one place that says so:
/// the configuration, changes while frames are deblurred, and the core all check against it.
///
/// Ranges that the meaning of a parameter does not give are wide: they catch values in the wrong
/// unit, and keep away what no arithmetic in float survives.
#pragma once

#include <cstdint>
#include <string>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Lowest and highest number that is accepted.
struct NumberRange {
  double lowest = 0.0;
  double highest = 0.0;
  bool or_zero = false;  ///< 0 is accepted, too: off, or not known

  /// False for NaN.
  bool contains(double value) const {
    return (value >= lowest && value <= highest) || (or_zero && value == 0.0);
  }
  /// E.g. "0 or 1..1000".
  std::string text() const;
};

struct ParameterRange {
  const char* name = "";  ///< that of the configuration's key
  const char* unit = "";  ///< empty when it has none
  NumberRange range;
};

/// A longer exposure is a wrong one.
constexpr std::int64_t kMaxExposure_ns = kNanosecondsPerSecond;
constexpr int kMaxLatentImages = 1000;  ///< per exposure

namespace limits {

constexpr ParameterRange kContrastOn{"contrast_threshold_on", "natural log", {0.01, 10.0}};
constexpr ParameterRange kContrastOff{"contrast_threshold_off", "natural log", {0.01, 10.0}};
constexpr ParameterRange kExposureTime{"exposure_time_us", "us", {1.0, 1e6, true}};
/// Either clock may start at 1970 or at 0.
constexpr ParameterRange kTimeOffset{"time_offset_us", "us", {-3e15, 3e15}};
constexpr ParameterRange kEventDelay{"event_delay_us", "us", {-15e3, 15e3}};
constexpr ParameterRange kCloseTimeout{"close_timeout_ms", "ms", {1.0, 60e3}};
constexpr ParameterRange kBackwardJump{"max_backward_jump_ms", "ms", {1.0, 3600e3}};
constexpr ParameterRange kForwardJump{"max_forward_jump_ms", "ms", {1.0, 3600e3}};
constexpr ParameterRange kBufferedEvents{"max_buffered_events", "events", {1.0, 4e9}};
constexpr ParameterRange kLatentImages{
    "latent_images", "images per exposure", {0.0, kMaxLatentImages}};
constexpr ParameterRange kLevelRamp{"level_ramp_ms", "ms", {0.1, 16.0, true}};
constexpr ParameterRange kLevelRampFraction{"level_ramp_fraction", "", {0.0, 1.0}};
constexpr ParameterRange kFilterGainNoise{"filter_gain_noise", "contrast thresholds", {0.01, 10.0}};
constexpr ParameterRange kFilterGainSigma{"filter_gain_sigma_px", "px", {0.1, 10.0}};
constexpr ParameterRange kFilterGainRestore{"filter_gain_restore", "", {0.0, 1.0}};
constexpr ParameterRange kFilterFrameNoiseKept{"filter_frame_noise_kept", "", {0.0, 1.0}};
constexpr ParameterRange kFilterTemporal{"filter_temporal", "", {0.0, 0.9}};
constexpr ParameterRange kFrameNoise{"frame_noise_dn", "8-bit DN", {0.01, 50.0, true}};
constexpr ParameterRange kResponseOffset{"response_offset_dn", "DN", {0.0, 255.0}};

}  // namespace limits

/// \throws std::invalid_argument such as "close_timeout_ms is 0, expected 1..60000 [ms]"
void requireWithin(const ParameterRange& parameter, double value);
/// The same with limits rounded to float, as the value was.
void requireWithin(const ParameterRange& parameter, float value);
/// The same for a duration in nanoseconds.
/// \param ns_per_unit of the parameter's unit
void requireWithin(const ParameterRange& parameter, std::int64_t value_ns,
                   std::int64_t ns_per_unit);

}  // namespace fast_edi
