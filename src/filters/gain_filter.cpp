#include "fast_edi/filters/gain_filter.hpp"
#include "fast_edi/base/parameter_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/fast_log.hpp"
#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

/// From here on, more events make a gain no noisier.
constexpr float kNoisiestCount = 30.0F;
/// So many events double the variance.
constexpr float kDoublingCount = 15.0F;
/// So many events leave half of what one leaves out.
constexpr float kHalfLeftOut = 5.0F;
constexpr float kHalf = 0.5F;
constexpr int kWindowRadius = 2;

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

FAST_EDI_VECTOR_CLONES
void addPairs(const std::uint16_t* __restrict counts, std::size_t pixels, float* __restrict sums) {
  for (std::size_t i = 0; i < pixels; ++i) {
    sums[i] = static_cast<float>(static_cast<int>(counts[2 * i]) +  //
                                 static_cast<int>(counts[2 * i + 1]));
  }
}

FAST_EDI_VECTOR_CLONES
void sumOfRows(const float* __restrict above, const float* __restrict row,
               const float* __restrict below, std::size_t width, float* __restrict sums) {
  for (std::size_t x = 0; x < width; ++x) {
    sums[x] = above[x] + row[x] + below[x];
  }
}

FAST_EDI_VECTOR_CLONES
void meansOfThree(const float* __restrict sums, std::size_t count, float scale,
                  float* __restrict means) {
  for (std::size_t i = 0; i < count; ++i) {
    means[i] = scale * (sums[i] + sums[i + 1] + sums[i + 2]);
  }
}

FAST_EDI_VECTOR_CLONES
void variances(const float* __restrict mean_count, std::size_t count, float least,
               float* __restrict variance) {
  for (std::size_t i = 0; i < count; ++i) {
    const float n = mean_count[i];
    // min(n, kNoisiestCount), without a comparison, which keeps GCC from vectorising.
    const float limited = kHalf * ((n + kNoisiestCount) - std::fabs(n - kNoisiestCount));
    variance[i] = least * (1.0F + limited * (1.0F / kDoublingCount));
  }
}

FAST_EDI_VECTOR_CLONES
void restore(const float* __restrict mean_count, std::size_t count, float strength,
             float* __restrict log_gain) {
  for (std::size_t i = 0; i < count; ++i) {
    const float n = mean_count[i] * (1.0F / kHalfLeftOut);
    log_gain[i] *= 1.0F + strength / (1.0F + n * n);
  }
}

/// Log gains of the largest and smallest gain are +-69.1; restored ones must not leave the range of
/// fastExp().
FAST_EDI_VECTOR_CLONES
void limit(std::size_t count, float* __restrict log_gain) {
  constexpr float kMax = 69.0F;
  for (std::size_t i = 0; i < count; ++i) {
    log_gain[i] = kHalf * (std::fabs(log_gain[i] + kMax) - std::fabs(log_gain[i] - kMax));
  }
}

}  // namespace

GainFilter::GainFilter(SensorSize size, const Settings& settings)
    : size_(size),
      settings_(settings),
      hot_pixels_(size),
      smoother_(size, {kWindowRadius, settings.spatial_sigma_px, 1}),
      log_gain_(size.pixelCount()),
      count_(size.pixelCount()),
      mean_count_(size.pixelCount()),
      variance_(size.pixelCount()) {
  if (!std::isfinite(settings.noise) || settings.noise <= 0.0F) {
    throw std::invalid_argument("noise of a log gain is " + std::to_string(settings.noise) +
                                ", expected a finite number > 0");
  }
  requireWithin(limits::kFilterGainRestore, settings.restore);
}

/// Means over 3 x 3 pixels; beyond the border the nearest pixel inside counts.
void GainFilter::averageCounts() {
  constexpr float kOneOfNine = 1.0F / 9.0F;
  const auto width = static_cast<std::size_t>(size_.width);
  std::vector<float>& sums = variance_;  // a row of it, which is written later
  std::vector<float> padded(width + 2);
  for (int y = 0; y < size_.height; ++y) {
    const auto row = [this, width](int i) {
      return count_.data() + static_cast<std::size_t>(std::clamp(i, 0, size_.height - 1)) * width;
    };
    sumOfRows(row(y - 1), row(y), row(y + 1), width, sums.data());
    std::copy(sums.data(), sums.data() + width, padded.data() + 1);
    padded.front() = sums[0];
    padded.back() = sums[width - 1];
    meansOfThree(padded.data(), width, kOneOfNine,
                 mean_count_.data() + static_cast<std::size_t>(y) * width);
  }
}

void GainFilter::apply(const float* level_dn, const ExposureEvents& events, float* gain) {
  const std::size_t pixels = size_.pixelCount();
  logOf(gain, pixels, log_gain_.data());
  addPairs(events.counts, pixels, count_.data());
  if (settings_.despeckle && hot_pixels_.find(level_dn, count_.data(), events) > 0) {
    hot_pixels_.fill(log_gain_.data());
    hot_pixels_.fill(count_.data());
  }
  averageCounts();
  if (settings_.smooth) {
    const double contrast = kHalf * (events.thresholds.on + events.thresholds.off);
    const float sigma = settings_.noise * static_cast<float>(contrast);
    variances(mean_count_.data(), pixels, sigma * sigma, variance_.data());
    smoother_.apply(log_gain_.data(), variance_.data(), log_gain_.data());
  }
  if (settings_.restore > 0.0F) {
    restore(mean_count_.data(), pixels, settings_.restore, log_gain_.data());
    limit(pixels, log_gain_.data());
  }
  expOf(log_gain_.data(), pixels, gain);
}

std::size_t GainFilter::memoryBytes() const {
  return smoother_.memoryBytes() + hot_pixels_.memoryBytes() +
         (log_gain_.capacity() + count_.capacity() + mean_count_.capacity() +
          variance_.capacity()) *
             sizeof(float);
}

}  // namespace fast_edi
