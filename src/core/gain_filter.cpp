#include "fast_edi/core/gain_filter.hpp"

#include <algorithm>

#include "fast_log.hpp"
#include "vector_clones.hpp"

namespace fast_edi {
namespace {

FAST_EDI_VECTOR_CLONES
void logOf(const float* __restrict in, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = fastLog(in[i]);
  }
}

FAST_EDI_VECTOR_CLONES
void expOf(const float* __restrict in, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = fastExp(in[i]);
  }
}

// One comparison a loop: GCC vectorises no more than that.

FAST_EDI_VECTOR_CLONES
void takeLower(const float* __restrict in, std::size_t count, float* __restrict lowest) {
  for (std::size_t i = 0; i < count; ++i) {
    lowest[i] = in[i] < lowest[i] ? in[i] : lowest[i];
  }
}

FAST_EDI_VECTOR_CLONES
void takeHigher(const float* __restrict in, std::size_t count, float* __restrict highest) {
  for (std::size_t i = 0; i < count; ++i) {
    highest[i] = in[i] > highest[i] ? in[i] : highest[i];
  }
}

}  // namespace

GainFilter::GainFilter(SensorSize size, const Settings& settings)
    : size_(size),
      settings_(settings),
      smoother_(size, {settings.range_log, settings.spatial_sigma_px, 1}),
      restoration_(size, settings.restore),
      log_gain_(size.pixelCount()),
      despeckled_(size.pixelCount()),
      lowest_(static_cast<std::size_t>(size.width)),
      highest_(static_cast<std::size_t>(size.width)) {}

void GainFilter::apply(float* gain) {
  logOf(gain, log_gain_.size(), log_gain_.data());
  if (settings_.despeckle) {
    despeckle();
  }
  if (settings_.smooth) {
    smoother_.apply(log_gain_.data(), log_gain_.data());
  }
  if (settings_.restore > 0.0F) {
    restoration_.apply(log_gain_.data());
  }
  expOf(log_gain_.data(), log_gain_.size(), gain);
}

/// Pixels of the border have too few neighbours to be judged and stay as they are.
void GainFilter::despeckle() {
  if (size_.width < 3 || size_.height < 3) {
    return;
  }
  const auto width = static_cast<std::size_t>(size_.width);
  const std::size_t inner = width - 2;
  despeckled_ = log_gain_;
  for (int y = 1; y + 1 < size_.height; ++y) {
    const float* above = log_gain_.data() + static_cast<std::size_t>(y - 1) * width;
    const float* row = above + width;
    const float* below = row + width;
    std::copy(above, above + inner, lowest_.begin());
    std::copy(above, above + inner, highest_.begin());
    for (const float* neighbour :
         {above + 1, above + 2, row, row + 2, below, below + 1, below + 2}) {
      takeLower(neighbour, inner, lowest_.data());
      takeHigher(neighbour, inner, highest_.data());
    }
    float* limited = despeckled_.data() + static_cast<std::size_t>(y) * width + 1;
    takeHigher(lowest_.data(), inner, limited);
    takeLower(highest_.data(), inner, limited);
  }
  log_gain_.swap(despeckled_);
}

std::size_t GainFilter::memoryBytes() const {
  return smoother_.memoryBytes() + restoration_.memoryBytes() +
         (log_gain_.capacity() + despeckled_.capacity() + lowest_.capacity() +
          highest_.capacity()) *
             sizeof(float);
}

}  // namespace fast_edi
