#include "survey/pixel_activity.hpp"

#include <algorithm>
#include <limits>

namespace fast_edi {
namespace {

constexpr std::int64_t kNoSlice = std::numeric_limits<std::int64_t>::min();
/// A hot pixel fires in (nearly) each of these.
constexpr std::int64_t kSlice_ns = 50 * kNanosecondsPerMillisecond;
constexpr std::uint64_t kLeastSlices = 8;
constexpr double kBusyShare = 0.9;
constexpr double kLeastHotRate_hz = 40.0;
/// ... and this often compared with the median of the 5 x 5 pixels around it.
constexpr double kTimesTheOthers = 5.0;
constexpr int kReach = 2;

}  // namespace

PixelActivity::PixelActivity(SensorSize size)
    : size_(size),
      counts_(size.pixelCount()),
      busy_slices_(size.pixelCount()),
      last_slice_(size.pixelCount(), kNoSlice) {}

void PixelActivity::restart(std::int64_t t_ns) {
  duration_ns_ += newest_ns_ - start_ns_;
  std::fill(last_slice_.begin(), last_slice_.end(), kNoSlice);
  start_ns_ = t_ns;
  newest_ns_ = t_ns;
  slice_ = kNoSlice;
}

void PixelActivity::add(const Event& event) {
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
}

std::uint64_t PixelActivity::inColumn(int x) const {
  std::uint64_t sum = 0;
  for (int y = 0; y < size_.height; ++y) {
    sum += counts_[pixelIndex(x, y)];
  }
  return sum;
}

std::uint64_t PixelActivity::inRow(int y) const {
  std::uint64_t sum = 0;
  for (int x = 0; x < size_.width; ++x) {
    sum += counts_[pixelIndex(x, y)];
  }
  return sum;
}

bool PixelActivity::neverRests(std::size_t pixel, double rate_hz) const {
  return rate_hz >= kLeastHotRate_hz &&
         busy_slices_[pixel] >= kBusyShare * static_cast<double>(slices_);
}

std::uint32_t PixelActivity::medianAround(int x, int y) const {
  constexpr std::size_t kSide = std::size_t{2} * kReach + 1;
  std::vector<std::uint32_t> around;
  around.reserve(kSide * kSide);
  for (int v = std::max(0, y - kReach); v <= std::min(size_.height - 1, y + kReach); ++v) {
    for (int u = std::max(0, x - kReach); u <= std::min(size_.width - 1, x + kReach); ++u) {
      around.push_back(counts_[pixelIndex(u, v)]);
    }
  }
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
  std::nth_element(around.begin(), middle, around.end());
  return *middle;
}

std::vector<HotPixel> PixelActivity::hotPixels() const {
  std::vector<HotPixel> hot;
  const double seconds = static_cast<double>(duration_ns_ + newest_ns_ - start_ns_) /
                         static_cast<double>(kNanosecondsPerSecond);
  if (slices_ < kLeastSlices || !(seconds > 0.0)) {
    return hot;
  }
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      const std::size_t pixel = pixelIndex(x, y);
      const double rate_hz = counts_[pixel] / seconds;
      if (neverRests(pixel, rate_hz) &&
          counts_[pixel] > kTimesTheOthers * (medianAround(x, y) + 1.0)) {
        hot.push_back({x, y, rate_hz});
      }
    }
  }
  std::sort(hot.begin(), hot.end(),
            [](const HotPixel& a, const HotPixel& b) { return a.rate_hz > b.rate_hz; });
  return hot;
}

}  // namespace fast_edi
