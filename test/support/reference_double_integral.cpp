#include "support/reference_double_integral.hpp"

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

}  // namespace

WindowLists windowLists(SensorSize size, const std::vector<Event>& events,
                        const ExposureInterval& window) {
  WindowLists lists;
  lists.pixels.resize(size.pixelCount());
  for (const Event& event : events) {
    if (event.x >= size.width || event.y >= size.height) continue;
    if (event.t_ns < window.start_ns || event.t_ns >= window.end_ns) continue;
    const std::size_t pixel = static_cast<std::size_t>(event.y) * size.width + event.x;
    lists.pixels[pixel].push_back({event.t_ns, lists.event_count, event.on});
    ++lists.event_count;
  }
  return lists;
}

long double pixelDoubleIntegral(const std::vector<PixelEvent>& list, std::int64_t window_events,
                                const ContrastThresholds& thresholds, Weighting weighting,
                                const ExposureInterval& window, std::int64_t reference_ns) {
  if (list.empty()) return 1.0L;

  Level reference_level;
  for (const PixelEvent& event : list) {
    if (event.t_ns < reference_ns) reference_level.add(event.on);
  }
  const long double reference_log = reference_level.log(thresholds);

  const bool by_time = weighting == Weighting::kTime;
  const std::int64_t end = by_time ? window.length() : window_events;
  std::int64_t clock = 0;
  Level level;
  long double sum = 0.0L;
  for (const PixelEvent& event : list) {
    const std::int64_t event_clock = by_time ? event.t_ns - window.start_ns : event.counter;
    sum += std::exp(level.log(thresholds) - reference_log) *
           static_cast<long double>(event_clock - clock);
    level.add(event.on);
    clock = event_clock;
  }
  sum += std::exp(level.log(thresholds) - reference_log) * static_cast<long double>(end - clock);
  return sum / static_cast<long double>(end);
}

std::vector<double> referenceDoubleIntegral(SensorSize size, const std::vector<Event>& events,
                                            const ContrastThresholds& thresholds,
                                            Weighting weighting, const ExposureInterval& window,
                                            std::int64_t reference_ns) {
  const WindowLists lists = windowLists(size, events, window);
  std::vector<double> result;
  result.reserve(lists.pixels.size());
  for (const std::vector<PixelEvent>& list : lists.pixels) {
    result.push_back(static_cast<double>(
        pixelDoubleIntegral(list, lists.event_count, thresholds, weighting, window, reference_ns)));
  }
  return result;
}

}  // namespace fast_edi::testing
