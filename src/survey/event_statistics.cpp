#include "survey/event_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fast_edi {
namespace {

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
/// A hot pixel fires in (nearly) each of these.
constexpr std::int64_t kSlice_ns = 50 * kNanosecondsPerMillisecond;
constexpr std::uint64_t kLeastSlices = 8;
constexpr double kBusyShare = 0.9;
constexpr double kLeastHotRate_hz = 40.0;
/// ... and this often compared with the median of the 5 x 5 pixels around it.
constexpr double kTimesTheOthers = 5.0;
constexpr int kReach = 2;

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

EventStatistics::EventStatistics(SensorSize size)
    : size_(size),
      stride_(static_cast<std::size_t>(size.width) + 2),
      last_ns_(stride_ * (static_cast<std::size_t>(size.height) + 2), kNever),
      counts_(size.pixelCount()),
      shortest_ns_(size.pixelCount(), std::numeric_limits<std::int64_t>::max()),
      busy_slices_(size.pixelCount()),
      last_slice_(size.pixelCount(), kNever) {}

void EventStatistics::restart(std::int64_t t_ns) {
  if (started_) {
    duration_ns_ += newest_ns_ - start_ns_;
  }
  std::fill(last_ns_.begin(), last_ns_.end(), kNever);
  std::fill(last_slice_.begin(), last_slice_.end(), kNever);
  start_ns_ = t_ns;
  newest_ns_ = t_ns;
  slice_ = kNever;
  started_ = true;
}

void EventStatistics::add(const Event& event) {
  largest_x_ = std::max(largest_x_, static_cast<int>(event.x));
  largest_y_ = std::max(largest_y_, static_cast<int>(event.y));
  if (event.x >= size_.width || event.y >= size_.height) {
    ++outside_;
    return;
  }
  if (!started_) {
    restart(event.t_ns);
  }
  ++(event.on ? on_ : off_);
  newest_ns_ = std::max(newest_ns_, event.t_ns);
  const std::int64_t slice = (event.t_ns - start_ns_) / kSlice_ns;
  if (slice > slice_) {
    slice_ = slice;
    ++slices_;
  }
  const std::size_t pixel = pixelIndex(event.x, event.y);
  ++counts_[pixel];
  if (last_slice_[pixel] != slice) {
    last_slice_[pixel] = slice;
    ++busy_slices_[pixel];
  }
  std::int64_t* last = &last_ns_[paddedIndex(event.x, event.y)];
  const auto stride = static_cast<std::ptrdiff_t>(stride_);
  const std::int64_t neighbours =
      std::max({last[-stride - 1], last[-stride], last[-stride + 1], last[-1], last[1],
                last[stride - 1], last[stride], last[stride + 1]});
  // Without any event before, the time since the start is the least that it can be.
  neighbour_times_.add(event.t_ns - std::max(neighbours, start_ns_));
  if (*last != kNever) {
    pixel_times_.add(event.t_ns - *last);
    shortest_ns_[pixel] = std::min(shortest_ns_[pixel], event.t_ns - *last);
  }
  *last = event.t_ns;
}

std::size_t EventStatistics::pixelsWithShortest(double from_ns, double to_ns) const {
  return static_cast<std::size_t>(
      std::count_if(shortest_ns_.begin(), shortest_ns_.end(), [&](std::int64_t time_ns) {
        return static_cast<double>(time_ns) >= from_ns && static_cast<double>(time_ns) < to_ns;
      }));
}

std::uint64_t EventStatistics::inColumn(int x) const {
  std::uint64_t sum = 0;
  for (int y = 0; y < size_.height; ++y) {
    sum += counts_[pixelIndex(x, y)];
  }
  return sum;
}

std::uint64_t EventStatistics::inRow(int y) const {
  std::uint64_t sum = 0;
  for (int x = 0; x < size_.width; ++x) {
    sum += counts_[pixelIndex(x, y)];
  }
  return sum;
}

std::vector<HotPixel> EventStatistics::hotPixels() const {
  std::vector<HotPixel> hot;
  const double seconds = static_cast<double>(duration_ns_ + newest_ns_ - start_ns_) /
                         static_cast<double>(kNanosecondsPerSecond);
  if (slices_ < kLeastSlices || !(seconds > 0.0)) {
    return hot;
  }
  std::vector<std::uint32_t> around;
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      const std::size_t pixel = pixelIndex(x, y);
      const double rate_hz = counts_[pixel] / seconds;
      if (rate_hz < kLeastHotRate_hz ||
          busy_slices_[pixel] < kBusyShare * static_cast<double>(slices_)) {
        continue;
      }
      around.clear();
      for (int v = std::max(0, y - kReach); v <= std::min(size_.height - 1, y + kReach); ++v) {
        for (int u = std::max(0, x - kReach); u <= std::min(size_.width - 1, x + kReach); ++u) {
          around.push_back(counts_[pixelIndex(u, v)]);
        }
      }
      const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
      std::nth_element(around.begin(), middle, around.end());
      if (counts_[pixel] > kTimesTheOthers * (*middle + 1.0)) {
        hot.push_back({x, y, rate_hz});
      }
    }
  }
  std::sort(hot.begin(), hot.end(),
            [](const HotPixel& a, const HotPixel& b) { return a.rate_hz > b.rate_hz; });
  return hot;
}

}  // namespace fast_edi
