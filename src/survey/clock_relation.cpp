#include "survey/clock_relation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>

#include "fast_edi/base/types.hpp"

namespace fast_edi {
namespace {

/// Over shorter times, delays of recording would pass for a rate.
constexpr std::int64_t kLeastSpan_ns = 200 * kNanosecondsPerMillisecond;
constexpr std::size_t kLeastReadings = 4;
/// Rates that differ by less may be delays, ...
constexpr double kLeastDifference = 0.2;
/// ... and this near to a simple number they are taken for it.
constexpr double kNear = 0.08;
constexpr std::array<int, 9> kFactors = {2, 3, 4, 5, 8, 10, 100, 1000, 1'000'000};
/// Stamps whose factor was undone lie this near to the events.
constexpr std::int64_t kSameClock_ns = kNanosecondsPerSecond;

template <typename Value>
Value median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::int64_t medianDelay(const std::vector<ClockReading>& readings) {
  std::vector<std::int64_t> delays;
  delays.reserve(readings.size());
  for (const ClockReading& reading : readings) {
    delays.push_back(reading.record_ns - reading.stamp_ns);
  }
  return median(std::move(delays));
}

/// Seconds of the stamps for each second of recording: the median over pairs half the recording
/// apart. Empty where that is too short a time.
std::optional<double> rateOf(const std::vector<ClockReading>& readings) {
  const std::size_t half = readings.size() / 2;
  if (readings.size() < kLeastReadings ||
      readings.back().record_ns - readings.front().record_ns < kLeastSpan_ns) {
    return std::nullopt;
  }
  std::vector<double> rates;
  for (std::size_t i = 0; i + half < readings.size(); ++i) {
    const std::int64_t recorded_ns = readings[i + half].record_ns - readings[i].record_ns;
    if (recorded_ns > 0) {
      rates.push_back(static_cast<double>(readings[i + half].stamp_ns - readings[i].stamp_ns) /
                      static_cast<double>(recorded_ns));
    }
  }
  return rates.empty() ? std::nullopt : std::optional<double>(median(std::move(rates)));
}

}  // namespace

std::optional<ClockRelation> relateClocks(const std::vector<ClockReading>& frames,
                                          const std::vector<ClockReading>& arrays) {
  if (frames.empty() || arrays.empty()) {
    return std::nullopt;
  }
  ClockRelation relation;
  const std::int64_t array_delay_ns = medianDelay(arrays);
  relation.offset_ns = medianDelay(frames) - array_delay_ns;
  const std::optional<double> frame_rate = rateOf(frames);
  const std::optional<double> event_rate = rateOf(arrays);
  if (!frame_rate || !event_rate || *frame_rate <= 0.0 || *event_rate <= 0.0) {
    return relation;
  }
  const double rate = *frame_rate / *event_rate;
  if (std::abs(rate - 1.0) < kLeastDifference) {
    return relation;
  }
  relation.rate = rate;
  for (const int factor : kFactors) {
    for (const bool divided : {false, true}) {
      const double simple = divided ? 1.0 / factor : factor;
      if (std::abs(rate / simple - 1.0) < kNear) {
        relation.factor = factor;
        relation.divided = divided;
      }
    }
  }
  relation.exact =
      relation.factor != 1 && std::all_of(frames.begin(), frames.end(), [&](const auto& frame) {
        return std::abs(relation.undone(frame.stamp_ns) - (frame.record_ns - array_delay_ns)) <
               kSameClock_ns;
      });
  return relation;
}

}  // namespace fast_edi
