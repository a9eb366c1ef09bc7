#include "survey/pair_consistency.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace fast_edi {
namespace {

constexpr double kResidualScale = 0.3;
/// Longer ramps than those that suit images: measured on simulated recordings, these find the
/// offset best, while thresholds hardly depend on the length (see pair_consistency_test.cpp).
constexpr LevelModel kLevel{8 * kNanosecondsPerMillisecond, 0.85};
constexpr ContrastThresholds kAnyThresholds{0.25, 0.25};
constexpr std::size_t kLeastPixels = 100;
/// Fewer events of change than this may be noise.
constexpr int kLeastChange = 2;
/// More events than this for each event of change: texture that came and went, or noise.
constexpr double kMostEventsPerChange = 1.3;
constexpr double kSpareEvents = 2.0;

/// Running sums of a correlation.
struct Correlation {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;

  void add(double a, double b) {
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  double value() const {
    const double variance_x = xx - x * x / n;
    const double variance_y = yy - y * y / n;
    const double product = variance_x * variance_y;
    return product > 0.0 ? (xy - x * y / n) / std::sqrt(product) : 0.0;
  }
};

bool covers(const PixelEventLists& events, const ExposureInterval& interval,
            std::int64_t first_ns) {
  return interval.start_ns >= first_ns && interval.end_ns <= events.newest();
}

std::int64_t firstEvent(const PixelEventLists& events) {
  const PackedEventSpan span = events.span(events.beginSequence(), events.endSequence());
  return span.base_ns + static_cast<std::int64_t>(span.data[0].dt_ns);
}

}  // namespace

std::optional<ExposureInterval> modelledExposure(const SampledFrame& frame,
                                                 const WindowModel& model) {
  const std::int64_t own = model.length_of_previous ? frame.previous_length_ns : frame.length_ns;
  const double length =
      model.length_ns > 0.0 ? model.length_ns : static_cast<double>(own) * model.length_factor;
  if (!(length >= 1.0)) {
    return std::nullopt;
  }
  const double middle = model.shift_ns + model.part * length;
  ExposureInterval exposure;
  exposure.start_ns = frame.stamp_ns + std::llround(middle - 0.5 * length);
  exposure.end_ns = exposure.start_ns + std::llround(length);
  return exposure;
}

void markInformative(TimingSample& sample, const ExposureInterval& interval) {
  const PixelEventLists& events = *sample.events;
  std::vector<int> count(events.size().pixelCount());
  std::vector<int> net(count.size());
  const std::uint64_t end = events.lowerBound(interval.end_ns);
  for (std::uint64_t sequence = events.lowerBound(interval.start_ns); sequence < end;) {
    const PackedEventSpan span = events.span(sequence, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::uint32_t pixel = span.data[i].code >> 1;
      ++count[pixel];
      net[pixel] += (span.data[i].code & 1u) != 0 ? 1 : -1;
    }
    sequence += span.count;
  }
  sample.informative.resize(count.size());
  for (std::size_t i = 0; i < count.size(); ++i) {
    const int change = std::abs(net[i]);
    sample.informative[i] =
        change >= kLeastChange && count[i] <= kMostEventsPerChange * change + kSpareEvents ? 1 : 0;
  }
}

PairConsistency::PairConsistency(SensorSize size)
    : size_(size),
      integral_(size, kAnyThresholds, Weighting::kTime, kLevel),
      first_gain_(size.pixelCount()),
      second_gain_(size.pixelCount()),
      level_(size.pixelCount()) {}

/// Ramps end where those of the integrals do: events behind an exposure are not known in it.
void PairConsistency::addLevels(const PixelEventLists& events, const ExposureInterval& first,
                                const ExposureInterval& second, ContrastThresholds thresholds) {
  std::fill(level_.begin(), level_.end(), 0.0F);
  const float step[2] = {static_cast<float>(thresholds.step(false)),
                         static_cast<float>(thresholds.step(true))};
  const LevelModel& model = integral_.level();
  const LevelInstant from{first.at(ExposureInstant::kMid), first.end_ns};
  const LevelInstant to{second.at(ExposureInstant::kMid), second.end_ns};
  const std::uint64_t end = events.lowerBound(second.end_ns);
  for (std::uint64_t sequence = events.lowerBound(from.t_ns); sequence < end;) {
    const PackedEventSpan span = events.span(sequence, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::int64_t t_ns = span.base_ns + static_cast<std::int64_t>(span.data[i].dt_ns);
      level_[span.data[i].code >> 1] +=
          step[span.data[i].code & 1u] *
          static_cast<float>(model.reached(t_ns, span.intervals[i], to) -
                             model.reached(t_ns, span.intervals[i], from));
    }
    sequence += span.count;
  }
}

std::optional<Consistency> PairConsistency::measure(const TimingSample& sample,
                                                    const WindowModel& model,
                                                    ContrastThresholds thresholds) {
  const std::optional<ExposureInterval> first = modelledExposure(sample.first, model);
  const std::optional<ExposureInterval> second = modelledExposure(sample.second, model);
  const PixelEventLists& events = *sample.events;
  if (!first || !second || events.empty()) {
    return std::nullopt;
  }
  const std::int64_t from_ns = firstEvent(events);
  const std::int64_t first_ns = first->at(ExposureInstant::kMid);
  const std::int64_t second_ns = second->at(ExposureInstant::kMid);
  if (!covers(events, *first, from_ns) || !covers(events, *second, from_ns) ||
      second_ns <= first_ns) {
    return std::nullopt;
  }
  integral_.setThresholds(thresholds);
  integral_.integrate(events, *first, first_ns, first_gain_.data());
  integral_.reset();
  integral_.integrate(events, *second, second_ns, second_gain_.data());
  integral_.reset();
  addLevels(events, *first, *second, thresholds);

  Correlation correlation;
  double cost = 0.0;
  for (std::size_t i = 0; i < level_.size(); ++i) {
    const float change = sample.second.log_exposure[i] - sample.first.log_exposure[i];
    if (std::isnan(change) || (!sample.informative.empty() && sample.informative[i] == 0)) {
      continue;
    }
    // gain = 1 / E
    const float predicted = level_[i] + std::log(first_gain_[i] / second_gain_[i]);
    const double residual = static_cast<double>(change - predicted) / kResidualScale;
    cost += std::log1p(residual * residual);
    correlation.add(static_cast<double>(predicted), static_cast<double>(change));
  }
  if (correlation.n < static_cast<double>(kLeastPixels)) {
    return std::nullopt;
  }
  Consistency result;
  result.cost = cost / correlation.n;
  result.correlation = correlation.value();
  return result;
}

}  // namespace fast_edi
