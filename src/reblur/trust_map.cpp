#include "reblur/trust_map.hpp"

#include <algorithm>
#include <cstring>

#include "base/vector_clones.hpp"
#include "reblur/log_levels.hpp"

namespace fast_edi {
namespace {

/// Of windows, in pixels of half the resolution.
constexpr std::size_t kResidualRadius = 3;
constexpr std::size_t kNearRadius = 1;
/// Of the neighbourhood: cells of 4 x 4 such pixels, and as many on each side.
constexpr std::size_t kCell = 4;
constexpr std::size_t kCellRadius = 5;

/// Trust falls, or grows, from one to the other.
struct Slope {
  float from;
  float to;
};
constexpr Slope kRemaining = {1.3F, 2.0F};  ///< mean square in units of the noise's
constexpr Slope kExplained = {0.1F, 0.4F};
constexpr Slope kNear = {0.1F, 0.3F};
constexpr Slope kAround = {0.1F, 0.2F};
/// Fewer comparable pixels than this share say as little as that many.
constexpr float kLeastComparable = 0.02F;
constexpr float kLeastTrust = 0.02F;
constexpr float kLeastSquare = 1e-3F;  ///< [DN^2]

constexpr float kQuarter = 0.25F;
/// Shares of the pixels of half the resolution that lie around one of full resolution.
constexpr float kCloser = 0.75F;
constexpr float kFarther = 0.25F;

constexpr float kPart = 0.3F;    ///< of the larger change
constexpr float kSteep = 0.25F;  ///< of the differences around

using MaskBlock = std::int32_t __attribute__((vector_size(kFloatBlock * sizeof(std::int32_t))));

inline void makeAbsolute(FloatBlock& values) {
  values = values < 0.0F ? -values : values;
}

struct Planes {
  const float* log_scene;  ///< at the first pixel of the row
  const float* log_taps;   ///< where taps count from
  std::size_t scene_stride;
  const float* change;
  std::int32_t* could;
  std::int32_t* does;
};

/// Compares a row's changes as predicted with those that events say.
FAST_EDI_VECTOR_CLONES
void compareRow(const Planes& row, const SceneLayout::Tap* taps, std::size_t blocks,
                float contrast) {
  for (std::size_t block = 0; block < blocks; ++block) {
    const float* upper = row.log_taps + taps[block].offset;
    const float* lower = upper + row.scene_stride;
    FloatBlock a;
    FloatBlock b;
    FloatBlock c;
    FloatBlock d;
    FloatBlock own;
    FloatBlock said;
    MaskBlock could;
    MaskBlock does;
    std::memcpy(&a, upper, sizeof(a));
    std::memcpy(&b, upper + 1, sizeof(b));
    std::memcpy(&c, lower, sizeof(c));
    std::memcpy(&d, lower + 1, sizeof(d));
    std::memcpy(&own, row.log_scene + block * kFloatBlock, sizeof(own));
    std::memcpy(&said, row.change + block * kFloatBlock, sizeof(said));
    std::memcpy(&could, row.could + block * kFloatBlock, sizeof(could));
    std::memcpy(&does, row.does + block * kFloatBlock, sizeof(does));
    const FloatBlock top = a + taps[block].x * (b - a);
    const FloatBlock bottom = c + taps[block].x * (d - c);
    const FloatBlock predicted = top + taps[block].y * (bottom - top) - own;
    FloatBlock p = predicted;
    FloatBlock s = said;
    FloatBlock apart = predicted - said;
    b -= a;
    d -= c;
    c -= a;
    FloatBlock right = c + d - b;  // the lower right pixel less the upper right one
    makeAbsolute(p);
    makeAbsolute(s);
    makeAbsolute(apart);
    makeAbsolute(b);
    makeAbsolute(c);
    makeAbsolute(d);
    makeAbsolute(right);
    const FloatBlock around = b + c + d + right;
    const FloatBlock larger = p > s ? p : s;
    const MaskBlock seen = larger > contrast;
    const MaskBlock wrong = apart > contrast + kPart * larger + kSteep * around;
    could |= seen;
    does |= seen & wrong;
    std::memcpy(row.could + block * kFloatBlock, &could, sizeof(could));
    std::memcpy(row.does + block * kFloatBlock, &does, sizeof(does));
  }
}

FAST_EDI_VECTOR_CLONES
void fromMask(const std::int32_t* __restrict mask, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<float>(-mask[i]);
  }
}

FAST_EDI_VECTOR_CLONES
void scaleRow(const float* __restrict in, std::size_t count, float factor, float* __restrict out) {
  for (std::size_t x = 0; x < count; ++x) {
    out[x] = factor * in[x];
  }
}

/// Means over 2 x 2 pixels.
FAST_EDI_VECTOR_CLONES
void halveRow(const float* __restrict upper, const float* __restrict lower, std::size_t count,
              float* __restrict out) {
  for (std::size_t x = 0; x < count; ++x) {
    out[x] = kQuarter * ((upper[2 * x] + upper[2 * x + 1]) + (lower[2 * x] + lower[2 * x + 1]));
  }
}

/// Their squares.
FAST_EDI_VECTOR_CLONES
void halveSquares(const float* __restrict upper, const float* __restrict lower, std::size_t count,
                  float* __restrict out) {
  for (std::size_t x = 0; x < count; ++x) {
    const float a = upper[2 * x];
    const float b = upper[2 * x + 1];
    const float c = lower[2 * x];
    const float d = lower[2 * x + 1];
    out[x] = kQuarter * ((a * a + b * b) + (c * c + d * d));
  }
}

/// \p near is the closer one of two rows or columns of half the resolution.
FAST_EDI_VECTOR_CLONES
void mixRows(const float* __restrict near, const float* __restrict far, std::size_t count,
             float* __restrict out) {
  for (std::size_t x = 0; x < count; ++x) {
    out[x] = kCloser * near[x] + kFarther * far[x];
  }
}

/// Twice as many, interpolated, and 0 where that is too little.
/// \param in with one value more on each side
FAST_EDI_VECTOR_CLONES
void doubleRow(const float* __restrict in, std::size_t count, float least, float* __restrict out) {
  for (std::size_t x = 0; x < count; ++x) {
    const float left = kCloser * in[x + 1] + kFarther * in[x];
    const float right = kCloser * in[x + 1] + kFarther * in[x + 2];
    out[2 * x] = left < least ? 0.0F : std::min(1.0F, left);
    out[2 * x + 1] = right < least ? 0.0F : std::min(1.0F, right);
  }
}

FAST_EDI_VECTOR_CLONES
void add(const float* __restrict in, std::size_t count, float* __restrict sum) {
  for (std::size_t i = 0; i < count; ++i) {
    sum[i] += in[i];
  }
}

FAST_EDI_VECTOR_CLONES
void multiply(const float* __restrict by, std::size_t count, float factor, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] *= by[i] * factor;
  }
}

/// How many of a window's pixels lie on the image.
float inside(std::size_t at, std::size_t radius, std::size_t length) {
  return static_cast<float>(std::min(at + radius, length - 1) - (at < radius ? 0 : at - radius) +
                            1);
}

/// Means over (2 radius + 1)^2 pixels, of those on the image; in place.
void boxMeans(std::vector<float>& plane, SensorSize size, std::size_t radius,
              std::vector<float>& rows) {
  const auto width = static_cast<std::size_t>(size.width);
  const auto height = static_cast<std::size_t>(size.height);
  std::vector<float> per_column(width);
  for (std::size_t x = 0; x < width; ++x) {
    per_column[x] = 1.0F / inside(x, radius, width);
  }
  rows.assign(plane.size(), 0.0F);
  for (std::size_t y = 0; y < height; ++y) {
    const std::size_t end = std::min(y + radius + 1, height);
    for (std::size_t i = y < radius ? 0 : y - radius; i < end; ++i) {
      add(plane.data() + i * width, width, rows.data() + y * width);
    }
  }
  std::vector<float> padded(width + 2 * radius);
  for (std::size_t y = 0; y < height; ++y) {
    float* out = plane.data() + y * width;
    std::copy_n(rows.data() + y * width, width, padded.data() + radius);
    std::fill(out, out + width, 0.0F);
    for (std::size_t shift = 0; shift <= 2 * radius; ++shift) {
      add(padded.data() + shift, width, out);
    }
    multiply(per_column.data(), width, 1.0F / inside(y, radius, height), out);
  }
}

float rise(float value, const Slope& slope) {
  return std::clamp((value - slope.from) * (1.0F / (slope.to - slope.from)), 0.0F, 1.0F);
}

FAST_EDI_VECTOR_CLONES
void trustResiduals(const float* __restrict before, const float* __restrict after,
                    std::size_t count, float noise_square, float* __restrict trust) {
  const float scale = 1.0F / noise_square;
  for (std::size_t i = 0; i < count; ++i) {
    const float share = 1.0F - after[i] / std::max(before[i], kLeastSquare);
    const float explained = (share - kExplained.from) * (1.0F / (kExplained.to - kExplained.from));
    const float quiet =
        (kRemaining.to - after[i] * scale) * (1.0F / (kRemaining.to - kRemaining.from));
    trust[i] = std::min(1.0F, std::max(0.0F, std::max(explained, quiet)));
  }
}

FAST_EDI_VECTOR_CLONES
void distrust(const float* __restrict share, std::size_t count, Slope slope,
              float* __restrict trust) {
  const float scale = 1.0F / (slope.to - slope.from);
  for (std::size_t i = 0; i < count; ++i) {
    trust[i] *= std::min(1.0F, std::max(0.0F, (slope.to - share[i]) * scale));
  }
}

}  // namespace

/// Logarithms of the scene at half the resolution. Its margin may be wider than half of the
/// scene's: there the nearest pixel counts.
void TrustMap::halveScene(const Input& input, const SceneLayout& layout,
                          const std::vector<float>& scene) {
  const std::size_t stride = half_.sceneStride();
  const std::size_t first = half_.margin() - layout.margin() / 2;
  const std::size_t count = std::min(layout.sceneStride() / 2, stride - first);
  log_scene_.resize(half_.sceneFloats());
  for (std::size_t y = 0; y < half_.sceneRows(); ++y) {
    const std::size_t inside = std::clamp(y, first, first + layout.sceneRows() / 2 - 1) - first;
    const float* upper = scene.data() + 2 * inside * layout.sceneStride();
    float* out = log_scene_.data() + y * stride;
    halveRow(upper, upper + layout.sceneStride(), count, out + first);
    std::fill(out, out + first, out[first]);
    std::fill(out + first + count, out + stride, out[first + count - 1]);
  }
  logLevels(log_scene_.data(), log_scene_.size(), input.offset_dn, log_scene_.data());
}

void TrustMap::fillTaps(const ImageMotion& motion, const ImageMotion::Parts& c, std::size_t group) {
  constexpr float kHalf = 0.5F;
  const float y = 2.0F * SceneLayout::centreOfGroup(group) + kHalf;
  for (std::size_t block = 0; block < half_.blocks(); ++block) {
    const Displacement u = motion.displace(c, 2.0F * SceneLayout::centreOf(block) + kHalf, y);
    taps_[block] = half_.tap(block, group * kRowsAlike, {kHalf * u.x, kHalf * u.y});
  }
}

void TrustMap::findContradictions(const Input& input) {
  const auto width = static_cast<std::size_t>(half_.size().width);
  could_.assign(half_.imageFloats(), 0);
  does_.assign(half_.imageFloats(), 0);
  row_.assign(half_.stride(), 0.0F);
  taps_.resize(half_.blocks());
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    const ImageMotion::Parts c = input.motion.at(EventChanges::kTau[k]);
    const float* change = input.changes.halvedAt(k).data();
    for (std::size_t y = 0; y < half_.rows(); ++y) {
      if (y % kRowsAlike == 0) {
        fillTaps(input.motion, c, y / kRowsAlike);
      }
      scaleRow(change + y * width, width, 1.0F / input.event_share, row_.data());
      compareRow(
          {log_scene_.data() + half_.inScene(0, y),
           log_scene_.data() + y % kRowsAlike * half_.sceneStride(), half_.sceneStride(),
           row_.data(), could_.data() + y * half_.stride(), does_.data() + y * half_.stride()},
          taps_.data(), half_.blocks(), input.contrast);
    }
  }
  contradicts_.resize(half_.size().pixelCount());
  comparable_.resize(half_.size().pixelCount());
  for (std::size_t y = 0; y < half_.rows(); ++y) {
    fromMask(does_.data() + y * half_.stride(), width, contradicts_.data() + y * width);
    fromMask(could_.data() + y * half_.stride(), width, comparable_.data() + y * width);
  }
}

void TrustMap::explain(const SceneLayout& layout, const ResidualSolver& solved, float noise_dn) {
  const SensorSize size = half_.size();
  const auto width = static_cast<std::size_t>(size.width);
  before_.resize(size.pixelCount());
  after_.resize(size.pixelCount());
  trusted_.resize(size.pixelCount());
  for (std::size_t y = 0; y < half_.rows(); ++y) {
    const std::size_t upper = 2 * y * layout.stride();
    const std::size_t lower = upper + layout.stride();
    const float* residual = solved.residualBefore().data();
    halveSquares(residual + upper, residual + lower, width, before_.data() + y * width);
    residual = solved.residualAfter().data();
    halveSquares(residual + upper, residual + lower, width, after_.data() + y * width);
  }
  boxMeans(before_, size, kResidualRadius, rows_);
  boxMeans(after_, size, kResidualRadius, rows_);
  trustResiduals(before_.data(), after_.data(), before_.size(),
                 std::max(kLeastSquare, noise_dn * noise_dn), trusted_.data());
}

/// Over cells, whose sums stand for those of their pixels.
void TrustMap::judgeNeighbourhood() {
  const SensorSize size = half_.size();
  const auto width = static_cast<std::size_t>(size.width);
  const auto height = static_cast<std::size_t>(size.height);
  const SensorSize cells{static_cast<int>((width + kCell - 1) / kCell),
                         static_cast<int>((height + kCell - 1) / kCell)};
  const auto columns = static_cast<std::size_t>(cells.width);
  std::vector<float> does(cells.pixelCount());
  std::vector<float> could(cells.pixelCount());
  std::vector<float> scratch;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t cell = y / kCell * columns + x / kCell;
      does[cell] += contradicts_[y * width + x];
      could[cell] += comparable_[y * width + x];
    }
  }
  boxMeans(does, cells, kCellRadius, scratch);
  boxMeans(could, cells, kCellRadius, scratch);
  constexpr auto kCellPixels = static_cast<float>(kCell * kCell);
  for (std::size_t i = 0; i < does.size(); ++i) {
    does[i] = 1.0F - rise(does[i] / std::max(could[i], kLeastComparable * kCellPixels), kAround);
  }
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      trusted_[y * width + x] *= does[y / kCell * columns + x / kCell];
    }
  }
}

/// To full resolution, linearly.
void TrustMap::spread() {
  const auto width = static_cast<std::size_t>(half_.size().width);
  const auto full_width = static_cast<std::size_t>(size_.width);
  const std::size_t last = half_.rows() - 1;
  row_.resize(width + 2);
  trust_.resize(size_.pixelCount());
  for (std::size_t y = 0; y < static_cast<std::size_t>(size_.height); ++y) {
    const std::size_t near = std::min(y / 2, last);
    const std::size_t far = y % 2 == 0 ? near - (near > 0 ? 1 : 0) : std::min(near + 1, last);
    mixRows(trusted_.data() + near * width, trusted_.data() + far * width, width, row_.data() + 1);
    row_.front() = row_[1];
    row_.back() = row_[width];
    float* out = trust_.data() + y * full_width;
    doubleRow(row_.data(), width, kLeastTrust, out);
    std::fill(out + 2 * width, out + full_width, out[2 * width - 1]);
  }
}

void TrustMap::measure(const Input& input, const SceneLayout& layout,
                       const ResidualSolver& solved) {
  constexpr float kHalf = 0.5F;
  size_ = layout.size();
  half_ = SceneLayout({size_.width / 2, size_.height / 2}, kHalf * layout.reach());
  explain(layout, solved, input.noise_dn);
  halveScene(input, layout, solved.solution());
  findContradictions(input);
  judgeNeighbourhood();
  boxMeans(contradicts_, half_.size(), kNearRadius, rows_);
  distrust(contradicts_.data(), contradicts_.size(), kNear, trusted_.data());
  boxMeans(trusted_, half_.size(), kNearRadius, rows_);
  spread();
}

std::size_t TrustMap::memoryBytes() const {
  std::size_t floats = could_.capacity() + does_.capacity();
  for (const std::vector<float>* plane : {&log_scene_, &row_, &contradicts_, &comparable_, &before_,
                                          &after_, &rows_, &trusted_, &trust_}) {
    floats += plane->capacity();
  }
  return floats * sizeof(float) + taps_.capacity() * sizeof(SceneLayout::Tap);
}

}  // namespace fast_edi
