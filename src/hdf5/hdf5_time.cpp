#include "hdf5/hdf5_time.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "fast_edi/base/types.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {
namespace {

/// In 2106, the last stamp [s].
constexpr double kLastSecond = 4294967296.0;
/// No recording lasts longer in the unit that is most likely [s].
constexpr double kLongest = 1e6;

constexpr std::array<std::pair<const char*, std::int64_t>, 12> kNames = {
    {{"ns", 1},
     {"nanoseconds", 1},
     {"us", kNanosecondsPerMicrosecond},
     {"\u00b5s", kNanosecondsPerMicrosecond},
     {"\u03bcs", kNanosecondsPerMicrosecond},
     {"microseconds", kNanosecondsPerMicrosecond},
     {"ms", kNanosecondsPerMillisecond},
     {"milliseconds", kNanosecondsPerMillisecond},
     {"s", kNanosecondsPerSecond},
     {"sec", kNanosecondsPerSecond},
     {"second", kNanosecondsPerSecond},
     {"seconds", kNanosecondsPerSecond}}};

constexpr std::int64_t kLastStamp_us = kLastStamp_ns / kNanosecondsPerMicrosecond;

bool isPlausible(double first, double last, std::int64_t unit_ns) {
  const double seconds = static_cast<double>(unit_ns) / static_cast<double>(kNanosecondsPerSecond);
  return std::abs(last) * seconds < kLastSecond && std::abs(last - first) * seconds <= kLongest;
}

}  // namespace

std::int64_t timeUnit(const std::string& said, bool is_whole, double first, double last) {
  for (const auto& [name, unit_ns] : kNames) {
    if (said == name) {
      return unit_ns;
    }
  }
  if (!is_whole && isPlausible(first, last, kNanosecondsPerSecond)) {
    return kNanosecondsPerSecond;
  }
  return isPlausible(first, last, kNanosecondsPerMicrosecond) ? kNanosecondsPerMicrosecond : 1;
}

std::optional<std::int64_t> timeOf(double time, std::int64_t unit_ns) {
  const double t_us =
      time * (static_cast<double>(unit_ns) / static_cast<double>(kNanosecondsPerMicrosecond));
  // Also refuses what is no number.
  if (!(t_us >= 0.0 && t_us <= static_cast<double>(kLastStamp_us))) {
    return std::nullopt;
  }
  return std::llround(t_us) * kNanosecondsPerMicrosecond;
}

std::optional<std::int64_t> timeOf(std::int64_t time, std::int64_t unit_ns) {
  return time >= 0 && time <= kLastStamp_ns / unit_ns ? std::optional(time * unit_ns)
                                                      : std::nullopt;
}

}  // namespace fast_edi
