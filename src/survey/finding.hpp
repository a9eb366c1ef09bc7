/// \file
/// What validate_bag says about a recording.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_mapping.hpp"

namespace fast_edi {

/// What made a recording, in whose words advice is given.
enum class RecordingOrigin {
  kRosDriver,  ///< a driver of ROS 1: a rosbag
  kDv,         ///< iniVation's DV: AEDAT4
  kOther,
};

/// One thing that breaks or weakens deblurring.
struct Finding {
  std::string name;      ///< a fixed word for each kind, e.g. "exposure-missing"
  std::string expected;  ///< what a sound recording has
  std::string found;
  std::string set;  ///< what to do: a parameter line, a driver setting
};

/// Values to be set, as far as the recording determines them.
struct ParameterProposal {
  ExposureInstant stamp_reference = ExposureInstant::kMid;
  std::int64_t time_offset_us = 0;
  std::int64_t exposure_time_us = 0;  ///< 0: the exposure topic has it, or it cannot be told
  EventMapping event_mapping;
  EventMapping given_mapping;  ///< that event_mapping takes the place of
  /// Where the given ones are wrong, or none are given, and the best ones are usual.
  std::optional<ContrastThresholds> thresholds;
  std::string offset_remark;  ///< what time_offset_us supposes, if anything
};

/// "start", "mid" or "end".
std::string instantName(ExposureInstant instant);

/// A millisecond, to divide times by that are shown in milliseconds [ns].
constexpr double kMs = static_cast<double>(kNanosecondsPerMillisecond);

/// A number as printf's %llu takes it.
inline unsigned long long count(std::uint64_t value) {
  return value;
}

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string textOf(const char* format, ...);

}  // namespace fast_edi
