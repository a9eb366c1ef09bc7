#include "fast_edi/latent/motion_compensation.hpp"

#include <algorithm>
#include <array>

#include "base/vector_clones.hpp"
#include "fast_edi/base/image_plane.hpp"
#include "filters/range_weight.hpp"

namespace fast_edi {
namespace {

// Chosen by the PSNR of high-rate videos of simulated sequences.
/// Where both agree; less than 1, since errors of the two are in part their own.
constexpr float kMaxWeight = 0.9F;
/// Relative difference at which w has fallen to 0.6 of that.
constexpr float kDisagreement = 0.1F;
/// Added to levels so that black does not make every difference a large one [8-bit DN].
constexpr float kLevelFloor_dn = 10.0F;
/// Of the differences that are averaged.
constexpr int kRadius = 2;

constexpr float kMaxLevel_dn = 255.0F;

/// Fractions of a pixel distance that weights are kept for.
constexpr int kFractions = 256;

FAST_EDI_VECTOR_CLONES
void sumOfRows(const float* const* rows, std::size_t count, std::size_t width,
               float* __restrict sums) {
  std::fill(sums, sums + width, 0.0F);
  for (std::size_t row = 0; row < count; ++row) {
    const float* __restrict in = rows[row];
    for (std::size_t x = 0; x < width; ++x) {
      sums[x] += in[x];
    }
  }
}

/// own += w difference, within the range of levels.
FAST_EDI_VECTOR_CLONES
void addWeighted(const float* __restrict difference, const float* __restrict mean_difference,
                 std::size_t count, float floor, float highest, float* __restrict own) {
  constexpr float kInverseRange = inverseRange(kDisagreement);
  for (std::size_t i = 0; i < count; ++i) {
    const float root = rangeWeightRoot(mean_difference[i] / (own[i] + floor), kInverseRange);
    const float w = root * root * (kMaxWeight * kRangeWeightScale);
    const float level = own[i] + w * difference[i];
    own[i] = std::min(std::max(level, 0.0F), highest);
  }
}

}  // namespace

/// Pixels of one colour along one axis.
struct MotionCompensation::Lattice {
  int first;
  int last;
  int stride;
  float inverse_stride;

  /// Of the pixel at \p i.
  Lattice(int i, int stride_px, int length)
      : first(i % stride_px),
        last(length - 1 - (length - 1 - i) % stride_px),
        stride(stride_px),
        inverse_stride(1.0F / static_cast<float>(stride_px)) {}
};

/// Four pixels of a lattice about a place between two of them.
struct MotionCompensation::Taps {
  int start;             ///< coordinate of the first, which may lie outside
  std::size_t fraction;  ///< of the way from the second to the third, in kFractions

  /// \param place within the image
  Taps(const Lattice& lattice, float place) {
    // One more, so that truncation rounds down left of the first one, too.
    const float steps = (place - static_cast<float>(lattice.first)) * lattice.inverse_stride + 1.0F;
    const int whole = static_cast<int>(steps);
    start = lattice.first + lattice.stride * (whole - 2);
    fraction = static_cast<std::size_t>((steps - static_cast<float>(whole)) * kFractions);
  }
  bool isWithin(const Lattice& lattice) const {
    return start >= lattice.first && start + 3 * lattice.stride <= lattice.last;
  }
  /// Beyond the border the nearest pixel of the lattice counts.
  std::size_t at(const Lattice& lattice, std::size_t k) const {
    return static_cast<std::size_t>(
        std::clamp(start + lattice.stride * static_cast<int>(k), lattice.first, lattice.last));
  }
};

MotionCompensation::MotionCompensation() {
  for (int i = 0; i < kFractions; ++i) {
    // Catmull-Rom.
    const float t = static_cast<float>(i) / kFractions;
    const float t2 = t * t;
    const float t3 = t2 * t;
    cubic_.push_back({0.5F * (-t3 + 2.0F * t2 - t), 0.5F * (3.0F * t3 - 5.0F * t2 + 2.0F),
                      0.5F * (-3.0F * t3 + 4.0F * t2 + t), 0.5F * (t3 - t2)});
  }
}

void MotionCompensation::fit(SensorSize size, PixelFormat format) {
  if (flow_ && size_ == size && format_ == format) {
    return;
  }
  size_ = size;
  format_ = format;
  stride_px_ = isBayer(format) ? 2 : 1;
  dn_ = static_cast<float>(dnPerDn8(format));
  flow_.emplace(size);
  const std::vector<float> plane(size.pixelCount());
  reference_.assign(static_cast<std::size_t>(channels(format)), plane);
  own_ = reference_;
  grey_ = plane;
  difference_ = plane;
  mean_difference_ = plane;
  row_sums_.resize(static_cast<std::size_t>(size.width));
}

std::size_t MotionCompensation::memoryBytes() const {
  const std::size_t planes = flow_ ? 2 * reference_.size() + 3 : 0;
  return planes * size_.pixelCount() * sizeof(float) + (flow_ ? flow_->memoryBytes() : 0);
}

void MotionCompensation::setReference(const ImageView& middle) {
  fit(middle.size, middle.format);
  loadPlanes(middle, reference_);
  flow_->setTarget(grey_.data());
}

void MotionCompensation::apply(const MutableImageView& image) {
  loadPlanes({image.data, image.size, image.step, image.format}, own_);
  const std::vector<Displacement>& flow = flow_->from(grey_.data());
  for (std::size_t channel = 0; channel < own_.size(); ++channel) {
    warp(reference_[channel], flow, own_[channel]);
    averageDifferences();
    addWeighted(difference_.data(), mean_difference_.data(), size_.pixelCount(),
                kLevelFloor_dn * dn_, kMaxLevel_dn * dn_, own_[channel].data());
    storePlane(own_[channel].data(), static_cast<int>(channel), image);
  }
}

/// The planes, and their mean in grey_.
void MotionCompensation::loadPlanes(const ImageView& image,
                                    std::vector<std::vector<float>>& planes) {
  std::fill(grey_.begin(), grey_.end(), 0.0F);
  const float scale = 1.0F / (dn_ * static_cast<float>(planes.size()));
  for (std::size_t channel = 0; channel < planes.size(); ++channel) {
    loadPlane(image, static_cast<int>(channel), planes[channel].data());
    for (std::size_t pixel = 0; pixel < grey_.size(); ++pixel) {
      grey_[pixel] += scale * planes[channel][pixel];
    }
  }
}

/// \param plane as large as the images
/// \pre x and y lie within the image
float MotionCompensation::sample(const float* plane, const Lattice& horizontal, float x,
                                 const Lattice& vertical, float y) const {
  const auto width = static_cast<std::size_t>(size_.width);
  const Taps across(horizontal, x);
  const Taps down(vertical, y);
  const CubicWeights& across_weights = cubic_[across.fraction];
  const CubicWeights& down_weights = cubic_[down.fraction];
  CubicWeights sums{};  // of each column
  if (stride_px_ == 1 && across.isWithin(horizontal) && down.isWithin(vertical)) {
    const float* levels = plane + static_cast<std::size_t>(down.start) * width +
                          static_cast<std::size_t>(across.start);
    for (std::size_t j = 0; j < sums.size(); ++j) {
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] += down_weights[j] * levels[j * width + i];
      }
    }
  } else {
    for (std::size_t j = 0; j < sums.size(); ++j) {
      const float* row = plane + down.at(vertical, j) * width;
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] += down_weights[j] * row[across.at(horizontal, i)];
      }
    }
  }
  float level = 0.0F;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    level += across_weights[i] * sums[i];
  }
  return level;
}

/// difference = reference(x + u) - own(x); 0 where x + u lies outside.
void MotionCompensation::warp(const std::vector<float>& reference,
                              const std::vector<Displacement>& flow,
                              const std::vector<float>& own) {
  const auto width = static_cast<std::size_t>(size_.width);
  const Lattice lattices[] = {{0, stride_px_, size_.width},
                              {stride_px_ - 1, stride_px_, size_.width}};
  for (int y = 0; y < size_.height; ++y) {
    const Lattice vertical(y, stride_px_, size_.height);
    for (int x = 0; x < size_.width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
      const float from_x = static_cast<float>(x) + flow[pixel].x;
      const float from_y = static_cast<float>(y) + flow[pixel].y;
      if (!(from_x >= 0.0F && from_x <= static_cast<float>(size_.width - 1) && from_y >= 0.0F &&
            from_y <= static_cast<float>(size_.height - 1))) {
        difference_[pixel] = 0.0F;
        continue;
      }
      difference_[pixel] =
          sample(reference.data(), lattices[x % 2], from_x, vertical, from_y) - own[pixel];
    }
  }
}

/// Means over 5 x 5 pixels; beyond the border the nearest pixel inside counts.
void MotionCompensation::averageDifferences() {
  constexpr int kDiameter = 2 * kRadius + 1;
  const auto width = static_cast<std::size_t>(size_.width);
  for (int y = 0; y < size_.height; ++y) {
    std::array<const float*, kDiameter> rows{};
    for (int k = 0; k < kDiameter; ++k) {
      const int row = std::clamp(y + k - kRadius, 0, size_.height - 1);
      rows[static_cast<std::size_t>(k)] =
          difference_.data() + static_cast<std::size_t>(row) * width;
    }
    sumOfRows(rows.data(), rows.size(), width, row_sums_.data());
    float* means = mean_difference_.data() + static_cast<std::size_t>(y) * width;
    for (int x = 0; x < size_.width; ++x) {
      float sum = 0.0F;
      for (int k = x - kRadius; k <= x + kRadius; ++k) {
        sum += row_sums_[static_cast<std::size_t>(std::clamp(k, 0, size_.width - 1))];
      }
      means[x] = sum / static_cast<float>(kDiameter * kDiameter);
    }
  }
}

}  // namespace fast_edi
