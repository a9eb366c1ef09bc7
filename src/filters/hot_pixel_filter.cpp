#include "fast_edi/filters/hot_pixel_filter.hpp"

#include <algorithm>
#include <cmath>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

/// Fewer events change a level by little more than their own quantisation.
constexpr float kFewestEvents = 6.0F;
/// Noise and leak events of the other polarity among those of a hot pixel.
constexpr float kOtherPolarity = 0.25F;
/// Half of the neighbourhood's width [px].
constexpr int kRadius = 3;
/// A pixel whose level changes by this part of that of the one that is looked at changes alike.
constexpr float kAlike = 1.0F / 3.0F;
/// Most of such pixels in the neighbourhood, itself included: a column, or a group of 2 x 3.
constexpr int kMostAlike = 2 * kRadius + 1;
/// What the change may exceed the range of the frame by: blur narrows that [natural log].
constexpr float kBeyondRange_log = 1.5F;
/// Keeps black from making every range a large one [8-bit DN].
constexpr float kLevelFloor_dn = 2.0F;

/// What the events of each pixel add up to [natural log], and whether these can be those of a hot
/// pixel at all: few are, so that the look at their neighbours costs little.
FAST_EDI_VECTOR_CLONES
void changesOf(const std::uint16_t* __restrict off_and_on, const float* __restrict count,
               std::size_t pixels, float threshold_on, float threshold_off,
               float* __restrict change, std::int32_t* __restrict is_suspect) {
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto off = static_cast<float>(static_cast<int>(off_and_on[2 * i]));
    const auto on = static_cast<float>(static_cast<int>(off_and_on[2 * i + 1]));
    change[i] = std::fabs(threshold_on * on - threshold_off * off);
    // A frame's range is not negative.
    const bool suspect = (count[i] >= kFewestEvents) &
                         (std::min(on, off) <= kOtherPolarity * count[i]) &
                         (change[i] > kBeyondRange_log);
    is_suspect[i] = suspect ? 1 : 0;
  }
}

}  // namespace

HotPixelFilter::HotPixelFilter(SensorSize size)
    : size_(size),
      change_(size.pixelCount()),
      is_suspect_(size.pixelCount()),
      is_hot_(size.pixelCount()) {}

bool HotPixelFilter::isHot(int x, int y, const float* level_dn, const float* count) const {
  const auto width = static_cast<std::size_t>(size_.width);
  const std::size_t pixel = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
  const float change = change_[pixel];
  int alike = 0;
  float lowest = level_dn[pixel];
  float highest = lowest;
  for (int row = std::max(y - kRadius, 0); row <= std::min(y + kRadius, size_.height - 1); ++row) {
    const std::size_t begin = static_cast<std::size_t>(row) * width;
    for (int column = std::max(x - kRadius, 0); column <= std::min(x + kRadius, size_.width - 1);
         ++column) {
      const std::size_t other = begin + static_cast<std::size_t>(column);
      const bool is_alike = change_[other] >= kAlike * change || count[other] >= count[pixel];
      alike += is_alike ? 1 : 0;
      lowest = std::min(lowest, level_dn[other]);
      highest = std::max(highest, level_dn[other]);
    }
    if (alike > kMostAlike) {
      return false;
    }
  }
  const float range = std::log((highest + kLevelFloor_dn) / (lowest + kLevelFloor_dn));
  return change > range + kBeyondRange_log;
}

std::size_t HotPixelFilter::find(const float* level_dn, const float* count,
                                 const ExposureEvents& events) {
  for (const std::size_t pixel : hot_) {
    is_hot_[pixel] = 0;
  }
  hot_.clear();
  changesOf(events.counts, count, is_hot_.size(), static_cast<float>(events.thresholds.on),
            static_cast<float>(events.thresholds.off), change_.data(), is_suspect_.data());
  const auto width = static_cast<std::size_t>(size_.width);
  for (std::size_t pixel = 0; pixel < is_hot_.size(); ++pixel) {
    if (is_suspect_[pixel] == 0) {
      continue;
    }
    if (isHot(static_cast<int>(pixel % width), static_cast<int>(pixel / width), level_dn, count)) {
      hot_.push_back(pixel);
      is_hot_[pixel] = 1;
    }
  }
  return hot_.size();
}

/// Of the nearest ring that has pixels which are not hot.
float HotPixelFilter::meanAround(std::size_t pixel, const float* plane) const {
  const auto width = static_cast<std::size_t>(size_.width);
  const int x = static_cast<int>(pixel % width);
  const int y = static_cast<int>(pixel / width);
  for (int radius = 1; radius <= kRadius; ++radius) {
    float sum = 0.0F;
    int others = 0;
    for (int row = std::max(y - radius, 0); row <= std::min(y + radius, size_.height - 1); ++row) {
      for (int column = std::max(x - radius, 0); column <= std::min(x + radius, size_.width - 1);
           ++column) {
        const std::size_t other =
            static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
        if (is_hot_[other] == 0) {
          sum += plane[other];
          ++others;
        }
      }
    }
    if (others > 0) {
      return sum / static_cast<float>(others);
    }
  }
  return 0.0F;
}

void HotPixelFilter::fill(float* plane) {
  filled_.clear();
  for (const std::size_t pixel : hot_) {
    filled_.push_back(meanAround(pixel, plane));
  }
  for (std::size_t i = 0; i < hot_.size(); ++i) {
    plane[hot_[i]] = filled_[i];
  }
}

}  // namespace fast_edi
