#include "fast_edi/core/gain_restoration.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fast_edi/core/number_text.hpp"
#include "vector_clones.hpp"

namespace fast_edi {
namespace {

/// Structure well above is no noise [natural log].
constexpr float kSureStructure_log = 0.055F;
/// What stands out by more is an edge, which smoothing leaves as it is [natural log].
constexpr float kMostStructure_log = 0.35F;
/// Units of the sums in one unit of log gain. With gains of up to +-70, the sum over a
/// neighbourhood of 289 pixels stays below 2^31.
constexpr float kUnitsPerLog = 65536.0F;

FAST_EDI_VECTOR_CLONES
void addUnits(const float* __restrict row, std::size_t width, float units,
              std::int32_t* __restrict sums) {
  for (std::size_t x = 0; x < width; ++x) {
    sums[x] += static_cast<std::int32_t>(row[x] * units);
  }
}

FAST_EDI_VECTOR_CLONES
void restore(const float* __restrict log_gain, const float* __restrict means, std::size_t width,
             float strength, float* __restrict restored) {
  for (std::size_t x = 0; x < width; ++x) {
    const float g = log_gain[x];
    const float d = g - means[x];
    // Limits without comparisons, which would keep GCC from vectorising the loop: to the range
    // between 0 and g, then to +-kMostStructure_log.
    const float part = 0.5F * (std::copysign(1.0F, g) * (std::fabs(d) - std::fabs(d - g)) + g);
    const float c =
        0.5F * (std::fabs(part + kMostStructure_log) - std::fabs(part - kMostStructure_log));
    const float squared = c * c;
    restored[x] =
        g + strength * c * (squared / (squared + kSureStructure_log * kSureStructure_log));
  }
}

}  // namespace

GainRestoration::GainRestoration(SensorSize size, float strength)
    : size_(size),
      strength_(strength),
      column_sums_(static_cast<std::size_t>(size.width)),
      means_(static_cast<std::size_t>(size.width)),
      original_(size.pixelCount()) {
  if (!(strength >= 0.0F && strength <= kMaxStrength)) {
    throw std::invalid_argument("gain restoration is " + numberText(static_cast<double>(strength)) +
                                ", expected 0 to " + numberText(static_cast<double>(kMaxStrength)));
  }
}

void GainRestoration::addRow(const float* row) {
  addUnits(row, column_sums_.size(), kUnitsPerLog, column_sums_.data());
}

void GainRestoration::removeRow(const float* row) {
  addUnits(row, column_sums_.size(), -kUnitsPerLog, column_sums_.data());
}

/// Means over the part of each neighbourhood that lies on the sensor.
void GainRestoration::meansOfRow(int y) {
  const int rows = std::min(y + kRadius, size_.height - 1) - std::max(y - kRadius, 0) + 1;
  const float per_row = 1.0F / (kUnitsPerLog * static_cast<float>(rows));
  const auto column = [this](int x) { return column_sums_[static_cast<std::size_t>(x)]; };
  std::int32_t sum = 0;
  int columns = 0;
  for (int x = 0; x < std::min(kRadius, size_.width); ++x, ++columns) {
    sum += column(x);
  }
  for (int x = 0; x < size_.width; ++x) {
    if (x + kRadius < size_.width) {
      sum += column(x + kRadius);
      ++columns;
    }
    if (x > kRadius) {
      sum -= column(x - kRadius - 1);
      --columns;
    }
    means_[static_cast<std::size_t>(x)] =
        static_cast<float>(sum) * per_row / static_cast<float>(columns);
  }
}

void GainRestoration::apply(float* log_gain) {
  const auto width = static_cast<std::size_t>(size_.width);
  std::copy(log_gain, log_gain + size_.pixelCount(), original_.begin());
  const auto row = [this, width](int y) {
    return original_.data() + static_cast<std::size_t>(y) * width;
  };
  std::fill(column_sums_.begin(), column_sums_.end(), 0);
  for (int y = 0; y < std::min(kRadius, size_.height); ++y) {
    addRow(row(y));
  }
  for (int y = 0; y < size_.height; ++y) {
    if (y + kRadius < size_.height) {
      addRow(row(y + kRadius));
    }
    if (y > kRadius) {
      removeRow(row(y - kRadius - 1));
    }
    meansOfRow(y);
    restore(row(y), means_.data(), width, strength_,
            log_gain + static_cast<std::size_t>(y) * width);
  }
}

}  // namespace fast_edi
