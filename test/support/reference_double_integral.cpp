#include "support/reference_double_integral.hpp"

#include <algorithm>
#include <cmath>

namespace fast_edi::testing {

namespace {

/// Log intensity after some events of one pixel, as whole events.
struct Level {
  std::int64_t on = 0;
  std::int64_t off = 0;

  void add(bool polarity_on) { ++(polarity_on ? on : off); }
  long double log(const ContrastThresholds& thresholds) const {
    return static_cast<long double>(on) * static_cast<long double>(thresholds.step(true)) +
           static_cast<long double>(off) * static_cast<long double>(thresholds.step(false));
  }
};

/// Length of the ramp between two events of a pixel: whole ticks less one, at most tau.
std::int64_t rampLength(std::int64_t previous_ns, std::int64_t t_ns, const LevelModel& level) {
  const std::int64_t ticks = t_ns / kIntervalTick_ns - previous_ns / kIntervalTick_ns - 1;
  const std::int64_t most = level.ramp_ns / kIntervalTick_ns;
  return std::min(std::max<std::int64_t>(ticks, 0), most) * kIntervalTick_ns;
}

/// Integral of the value over [from, to), in which the log level goes linearly from \p log_from to
/// \p log_to.
long double stretch(long double log_from, long double log_to, long double length) {
  const long double d = log_to - log_from;
  const long double mean = d == 0.0L ? 1.0L : std::expm1(d) / d;
  return std::exp(log_from) * mean * length;
}

}  // namespace

WindowLists windowLists(SensorSize size, const std::vector<Event>& events,
                        const ExposureInterval& window, const LevelModel& level) {
  WindowLists lists;
  lists.pixels.resize(size.pixelCount());
  std::vector<std::int64_t> previous(size.pixelCount(), INT64_MIN / 2);
  for (const Event& event : events) {
    if (event.x >= size.width || event.y >= size.height) continue;
    const std::size_t pixel = static_cast<std::size_t>(event.y) * size.width + event.x;
    const std::int64_t ramp_ns = rampLength(previous[pixel], event.t_ns, level);
    previous[pixel] = event.t_ns;
    if (event.t_ns < window.start_ns || event.t_ns >= window.end_ns) continue;
    lists.pixels[pixel].push_back({event.t_ns, lists.event_count, event.on, ramp_ns});
    ++lists.event_count;
  }
  return lists;
}

long double pixelDoubleIntegral(const std::vector<PixelEvent>& list, std::int64_t window_events,
                                const ContrastThresholds& thresholds, Weighting weighting,
                                const ExposureInterval& window, std::int64_t reference_ns,
                                double fraction) {
  if (list.empty()) return 1.0L;

  // Relative to the level before an event's ramp: what it has gained at an instant of the ramp.
  const auto gained = [&](const PixelEvent& event, std::int64_t t_ns) {
    const std::int64_t done_ns = t_ns - (event.t_ns - event.ramp_ns);
    return event.ramp_ns == 0 || done_ns <= 0
               ? 0.0L
               : static_cast<long double>(fraction) *
                     static_cast<long double>(thresholds.step(event.on)) *
                     static_cast<long double>(done_ns) / static_cast<long double>(event.ramp_ns);
  };
  Level reference_level;
  long double reference_ramp = 0.0L;
  for (const PixelEvent& event : list) {
    if (event.t_ns < reference_ns) {
      reference_level.add(event.on);
    } else {
      reference_ramp = gained(event, reference_ns);
      break;
    }
  }
  const long double reference_log = reference_level.log(thresholds) + reference_ramp;

  const bool by_time = weighting == Weighting::kTime;
  const std::int64_t end = by_time ? window.length() : window_events;
  std::int64_t clock = 0;
  Level level;
  long double sum = 0.0L;
  for (const PixelEvent& event : list) {
    const std::int64_t event_clock = by_time ? event.t_ns - window.start_ns : event.counter;
    const long double log_before = level.log(thresholds) - reference_log;
    const std::int64_t ramp_start = std::max(clock, event_clock - event.ramp_ns);
    sum += stretch(log_before, log_before, static_cast<long double>(ramp_start - clock));
    if (event.ramp_ns > 0) {
      sum += stretch(log_before + gained(event, window.start_ns + ramp_start),
                     log_before + gained(event, event.t_ns),
                     static_cast<long double>(event_clock - ramp_start));
    }
    level.add(event.on);
    clock = event_clock;
  }
  sum += std::exp(level.log(thresholds) - reference_log) * static_cast<long double>(end - clock);
  return sum / static_cast<long double>(end);
}

std::vector<double> referenceDoubleIntegral(SensorSize size, const std::vector<Event>& events,
                                            const ContrastThresholds& thresholds,
                                            Weighting weighting, const ExposureInterval& window,
                                            std::int64_t reference_ns, const LevelModel& level) {
  const WindowLists lists = windowLists(size, events, window, level);
  std::vector<double> result;
  result.reserve(lists.pixels.size());
  for (const std::vector<PixelEvent>& list : lists.pixels) {
    result.push_back(static_cast<double>(pixelDoubleIntegral(
        list, lists.event_count, thresholds, weighting, window, reference_ns, level.fraction)));
  }
  return result;
}

}  // namespace fast_edi::testing
