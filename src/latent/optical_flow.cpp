#include "fast_edi/latent/optical_flow.hpp"

#include <algorithm>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

// Chosen by the PSNR of high-rate videos of simulated sequences; radii of 4 to 6 and lambdas of 8
// to 50 differ by 0.3 dB at most.
/// Of the box filter that is applied twice: standard deviation 4.5 px.
constexpr int kRadius = 5;
/// Holds displacements where gradients are weak [DN^2 / px^2].
constexpr float kLambda = 20.0F;
constexpr int kIterations = 2;

/// No level is smaller in either direction [px].
constexpr int kSmallestLevel_px = 8;
constexpr std::size_t kMaxLevels = 4;

// Of the terms of a pixel: products of the gradient (x, y) with itself and with the difference r.
constexpr std::size_t kXX = 0;
constexpr std::size_t kXY = 1;
constexpr std::size_t kYY = 2;
constexpr std::size_t kXR = 3;
constexpr std::size_t kYR = 4;
constexpr std::size_t kTerms = 8;

SensorSize half(SensorSize size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

std::size_t indexOf(SensorSize size, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
         static_cast<std::size_t>(x);
}

bool isInside(SensorSize size, float x, float y) {
  return x >= 0.0F && y >= 0.0F && x <= static_cast<float>(size.width - 1) &&
         y <= static_cast<float>(size.height - 1);
}

/// Means of 2 x 2 pixels; an odd last row or column counts twice.
void downsample(SensorSize fine, const float* in, std::vector<float>& out) {
  const SensorSize coarse = half(fine);
  out.resize(coarse.pixelCount());
  for (int y = 0; y < coarse.height; ++y) {
    const int above = 2 * y;
    const int below = std::min(above + 1, fine.height - 1);
    for (int x = 0; x < coarse.width; ++x) {
      const int left = 2 * x;
      const int right = std::min(left + 1, fine.width - 1);
      out[indexOf(coarse, x, y)] =
          0.25F * (in[indexOf(fine, left, above)] + in[indexOf(fine, right, above)] +
                   in[indexOf(fine, left, below)] + in[indexOf(fine, right, below)]);
    }
  }
}

FAST_EDI_VECTOR_CLONES
void add(const float* __restrict in, std::size_t count, float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) {
    sums[i] += in[i];
  }
}

FAST_EDI_VECTOR_CLONES
void subtract(const float* __restrict in, std::size_t count, float* __restrict sums) {
  for (std::size_t i = 0; i < count; ++i) {
    sums[i] -= in[i];
  }
}

/// Sums over 2 kRadius + 1 pixels of a row; beyond its ends there is nothing.
/// \param in, out width x kTerms floats
FAST_EDI_VECTOR_CLONES
void sumAlongRow(const float* __restrict in, int width, float* __restrict out) {
  static constexpr float kNothing[kTerms] = {};
  const auto at = [in, width](int x) {
    return x >= 0 && x < width ? in + static_cast<std::size_t>(x) * kTerms : kNothing;
  };
  float sum[kTerms] = {};
  for (int x = 0; x < kRadius; ++x) {
    const float* comes = at(x);
    for (std::size_t k = 0; k < kTerms; ++k) sum[k] += comes[k];
  }
  for (int x = 0; x < width; ++x) {
    const float* comes = at(x + kRadius);
    const float* goes = at(x - kRadius - 1);
    for (std::size_t k = 0; k < kTerms; ++k) {
      sum[k] += comes[k] - goes[k];
      out[static_cast<std::size_t>(x) * kTerms + k] = sum[k];
    }
  }
}

/// Of a fine pixel, from the coarse one that it lies in and its nearest neighbour there: the centre
/// of a coarse pixel lies between those of its fine ones.
constexpr float kNear = 0.75F;
constexpr float kFar = 0.25F;

/// out = kNear near + kFar far
FAST_EDI_VECTOR_CLONES
void mixRows(const Displacement* __restrict near, const Displacement* __restrict far, int width,
             Displacement* __restrict out) {
  for (int x = 0; x < width; ++x) {
    out[x] = {kNear * near[x].x + kFar * far[x].x, kNear * near[x].y + kFar * far[x].y};
  }
}

}  // namespace

OpticalFlow::OpticalFlow(SensorSize size) : size_(size) {
  do {
    size = half(size);
    target_.push_back({size, {}});
    from_.push_back({size, {}});
  } while (target_.size() < kMaxLevels &&
           std::min(size.width, size.height) >= 2 * kSmallestLevel_px);
  const std::size_t pixels = target_.front().size.pixelCount();
  warped_.resize(pixels);
  terms_.resize(pixels * kTerms);
  row_sums_.resize(pixels * kTerms);
}

std::size_t OpticalFlow::memoryBytes() const {
  std::size_t bytes =
      (flow_.at.capacity() + coarse_flow_.capacity() + coarse_row_.capacity()) *
          sizeof(Displacement) +
      (warped_.capacity() + terms_.capacity() + row_sums_.capacity() + column_sums_.capacity()) *
          sizeof(float);
  for (std::size_t level = 0; level < target_.size(); ++level) {
    bytes += (target_[level].at.capacity() + from_[level].at.capacity()) * sizeof(float);
  }
  return bytes;
}

void OpticalFlow::buildPyramid(const float* plane, std::vector<Grid<float>>& levels) const {
  SensorSize size = size_;
  for (Grid<float>& level : levels) {
    downsample(size, plane, level.at);
    plane = level.at.data();
    size = level.size;
  }
}

void OpticalFlow::setTarget(const float* plane) {
  buildPyramid(plane, target_);
}

const std::vector<Displacement>& OpticalFlow::from(const float* plane) {
  buildPyramid(plane, from_);
  flow_.size = from_.back().size;
  flow_.at.assign(flow_.size.pixelCount(), {});
  for (std::size_t level = from_.size(); level-- > 0;) {
    for (int i = 0; i < kIterations; ++i) {
      refine(level);
    }
    upsample(level > 0 ? from_[level - 1].size : size_);
  }
  return flow_.at;
}

void OpticalFlow::refine(std::size_t level) {
  warpTarget(target_[level]);
  collectTerms(from_[level]);
  sumOverWindows(flow_.size);
  sumOverWindows(flow_.size);
  solve();
}

/// warped(x) = target(x + u), bilinear; beyond the border the nearest pixel inside counts.
void OpticalFlow::warpTarget(const Grid<float>& target) {
  const auto [width, height] = target.size;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = indexOf(target.size, x, y);
      const Displacement u = flow_.at[pixel];
      const float tx = std::clamp(static_cast<float>(x) + u.x, 0.0F, static_cast<float>(width - 1));
      const float ty =
          std::clamp(static_cast<float>(y) + u.y, 0.0F, static_cast<float>(height - 1));
      const int left = static_cast<int>(tx);
      const int top = static_cast<int>(ty);
      const int right = std::min(left + 1, width - 1);
      const int bottom = std::min(top + 1, height - 1);
      const float fx = tx - static_cast<float>(left);
      const float fy = ty - static_cast<float>(top);
      const auto between = [&](int row) {
        const float start = target.at[indexOf(target.size, left, row)];
        return start + fx * (target.at[indexOf(target.size, right, row)] - start);
      };
      const float upper = between(top);
      warped_[pixel] = upper + fy * (between(bottom) - upper);
    }
  }
}

/// With g the gradient and d = from - warped, linearising gives d = g (u_new - u), so that
/// r = d + g u is what g u_new is to be.
void OpticalFlow::collectTerms(const Grid<float>& from) {
  const auto [width, height] = from.size;
  const auto mean = [&](int x, int y) {
    const std::size_t pixel = indexOf(from.size, x, y);
    return 0.5F * (from.at[pixel] + warped_[pixel]);
  };
  for (int y = 0; y < height; ++y) {
    const int above = std::max(y - 1, 0);
    const int below = std::min(y + 1, height - 1);
    for (int x = 0; x < width; ++x) {
      const int left = std::max(x - 1, 0);
      const int right = std::min(x + 1, width - 1);
      // Scharr's or Sobel's smoothing across is left to the window.
      const float gx = 0.5F * (mean(right, y) - mean(left, y));
      const float gy = 0.5F * (mean(x, below) - mean(x, above));
      const std::size_t pixel = indexOf(from.size, x, y);
      const Displacement u = flow_.at[pixel];
      if (!isInside(from.size, static_cast<float>(x) + u.x, static_cast<float>(y) + u.y)) {
        std::fill_n(terms_.begin() + static_cast<std::ptrdiff_t>(pixel * kTerms), kTerms, 0.0F);
        continue;  // it says nothing
      }
      const float r = from.at[pixel] - warped_[pixel] + gx * u.x + gy * u.y;
      float* of = terms_.data() + pixel * kTerms;
      of[kXX] = gx * gx;
      of[kXY] = gx * gy;
      of[kYY] = gy * gy;
      of[kXR] = gx * r;
      of[kYR] = gy * r;
      std::fill(of + kYR + 1, of + kTerms, 0.0F);
    }
  }
}

void OpticalFlow::sumOverWindows(SensorSize size) {
  const std::size_t floats = static_cast<std::size_t>(size.width) * kTerms;
  const auto row = [floats](std::vector<float>& terms, int y) {
    return terms.data() + static_cast<std::size_t>(y) * floats;
  };
  for (int y = 0; y < size.height; ++y) {
    sumAlongRow(row(terms_, y), size.width, row(row_sums_, y));
  }
  column_sums_.assign(floats, 0.0F);
  for (int y = 0; y < std::min(kRadius, size.height); ++y) {
    add(row(row_sums_, y), floats, column_sums_.data());
  }
  for (int y = 0; y < size.height; ++y) {
    if (y + kRadius < size.height) {
      add(row(row_sums_, y + kRadius), floats, column_sums_.data());
    }
    if (y > kRadius) {
      subtract(row(row_sums_, y - kRadius - 1), floats, column_sums_.data());
    }
    std::copy(column_sums_.begin(), column_sums_.end(), row(terms_, y));
  }
}

void OpticalFlow::solve() {
  constexpr int kDiameter = 2 * kRadius + 1;
  constexpr float kHold = kLambda * kDiameter * kDiameter * kDiameter * kDiameter;
  for (std::size_t pixel = 0; pixel < flow_.at.size(); ++pixel) {
    const float* of = terms_.data() + pixel * kTerms;
    Displacement& u = flow_.at[pixel];
    const float xx = of[kXX] + kHold;
    const float yy = of[kYY] + kHold;
    const float xy = of[kXY];
    const float xr = of[kXR] + kHold * u.x;
    const float yr = of[kYR] + kHold * u.y;
    const float determinant = xx * yy - xy * xy;
    u = {(yy * xr - xy * yr) / determinant, (xx * yr - xy * xr) / determinant};
  }
}

/// Bilinear. Displacements double along with the size.
void OpticalFlow::upsample(SensorSize size) {
  std::swap(coarse_flow_, flow_.at);
  const SensorSize coarse = flow_.size;
  flow_.size = size;
  flow_.at.resize(size.pixelCount());
  coarse_row_.resize(static_cast<std::size_t>(coarse.width));
  for (int y = 0; y < size.height; ++y) {
    const int far_y = std::clamp(y / 2 + (y % 2 == 0 ? -1 : 1), 0, coarse.height - 1);
    mixRows(coarse_flow_.data() + indexOf(coarse, 0, y / 2),
            coarse_flow_.data() + indexOf(coarse, 0, far_y), coarse.width, coarse_row_.data());
    Displacement* row = flow_.at.data() + indexOf(size, 0, y);
    for (int x = 0; x < size.width; ++x) {
      const int far_x = std::clamp(x / 2 + (x % 2 == 0 ? -1 : 1), 0, coarse.width - 1);
      const Displacement& near = coarse_row_[static_cast<std::size_t>(x / 2)];
      const Displacement& far = coarse_row_[static_cast<std::size_t>(far_x)];
      row[x] = {2.0F * (kNear * near.x + kFar * far.x), 2.0F * (kNear * near.y + kFar * far.y)};
    }
  }
}

}  // namespace fast_edi
