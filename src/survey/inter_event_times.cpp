#include "survey/inter_event_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fast_edi {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

}  // namespace

double TimeHistogram::binStartNs(std::size_t bin) {
  return 1e3 * std::exp2(static_cast<double>(bin) / kPerOctave);
}

void TimeHistogram::add(std::int64_t time_ns) {
  ++total_;
  const double octaves = std::log2(static_cast<double>(std::max<std::int64_t>(time_ns, 1)) * 1e-3);
  const auto bin = static_cast<std::ptrdiff_t>(std::floor(octaves * kPerOctave));
  ++counts_[static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(bin, 0, static_cast<std::ptrdiff_t>(kBins) - 1))];
}

std::uint64_t TimeHistogram::sum(std::size_t first, std::size_t last) const {
  std::uint64_t sum = 0;
  for (std::size_t bin = first; bin < std::min(last, kBins); ++bin) {
    sum += counts_[bin];
  }
  return sum;
}

InterEventTimes::InterEventTimes(SensorSize size)
    : width_(static_cast<std::size_t>(size.width)),
      stride_(width_ + 2),
      last_ns_(stride_ * (static_cast<std::size_t>(size.height) + 2), kNever),
      shortest_ns_(size.pixelCount(), std::numeric_limits<std::int64_t>::max()) {}

void InterEventTimes::restart(std::int64_t t_ns) {
  std::fill(last_ns_.begin(), last_ns_.end(), kNever);
  start_ns_ = t_ns;
}

void InterEventTimes::add(const Event& event) {
  std::int64_t* last = &last_ns_[(event.y + std::size_t{1}) * stride_ + event.x + 1];
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  const std::int64_t neighbours =
      std::max({last[-stride - 1], last[-stride], last[-stride + 1], last[-1], last[1],
                last[stride - 1], last[stride], last[stride + 1]});
  // Without any event before, the time since the start is the least that it can be.
  of_neighbours_.add(event.t_ns - std::max(neighbours, start_ns_));
  if (*last != kNever) {
    const std::int64_t time_ns = event.t_ns - *last;
    std::int64_t& shortest_ns = shortest_ns_[event.y * width_ + event.x];
    of_pixels_.add(time_ns);
    shortest_ns = std::min(shortest_ns, time_ns);
  }
  *last = event.t_ns;
}

std::size_t InterEventTimes::pixelsWithShortest(double from_ns, double to_ns) const {
  return static_cast<std::size_t>(
      std::count_if(shortest_ns_.begin(), shortest_ns_.end(), [&](std::int64_t time_ns) {
        return static_cast<double>(time_ns) >= from_ns && static_cast<double>(time_ns) < to_ns;
      }));
}

}  // namespace fast_edi
