#include "reblur/trust_map.hpp"

#include <algorithm>
#include <cstring>

#include "base/vector_clones.hpp"
#include "reblur/log_levels.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kResidualRadius = 7;
constexpr std::size_t kNearRadius = 2;
/// Of the neighbourhood: cells of 8 x 8 pixels, and as many on each side.
constexpr std::size_t kCell = 8;
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

constexpr float kPart = 0.3F;   ///< of the larger change
constexpr float kSteep = 0.5F;  ///< of the differences around

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
void squaresOf(const float* __restrict in, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = in[i] * in[i];
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

void TrustMap::findContradictions(const Input& input, const SceneLayout& layout,
                                  const std::vector<float>& scene) {
  const auto width = static_cast<std::size_t>(layout.size().width);
  log_scene_.resize(scene.size());
  logLevels(scene.data(), scene.size(), input.offset_dn, log_scene_.data());
  could_.assign(layout.imageFloats(), 0);
  does_.assign(layout.imageFloats(), 0);
  padded_change_.assign(layout.stride(), 0.0F);
  std::vector<SceneLayout::Tap> taps(layout.blocks());
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    const ImageMotion::Parts c = input.motion.at(EventChanges::kTau[k]);
    const float* change = input.changes.at(k).data();
    for (std::size_t y = 0; y < layout.rows(); ++y) {
      for (std::size_t block = 0; block < layout.blocks(); ++block) {
        taps[block] = layout.tap(
            block, y,
            input.motion.displace(c, SceneLayout::centreOf(block), static_cast<float>(y)));
      }
      std::copy_n(change + y * width, width, padded_change_.data());
      compareRow({log_scene_.data() + layout.inScene(0, y), log_scene_.data(), layout.sceneStride(),
                  padded_change_.data(), could_.data() + y * layout.stride(),
                  does_.data() + y * layout.stride()},
                 taps.data(), layout.blocks(), input.contrast);
    }
  }
  contradicts_.resize(layout.size().pixelCount());
  comparable_.resize(layout.size().pixelCount());
  for (std::size_t y = 0; y < layout.rows(); ++y) {
    fromMask(does_.data() + y * layout.stride(), width, contradicts_.data() + y * width);
    fromMask(could_.data() + y * layout.stride(), width, comparable_.data() + y * width);
  }
}

void TrustMap::explain(const SceneLayout& layout, const ResidualSolver& solved, float noise_dn) {
  const std::size_t pixels = layout.size().pixelCount();
  const auto width = static_cast<std::size_t>(layout.size().width);
  before_.resize(pixels);
  after_.resize(pixels);
  trust_.resize(pixels);
  for (std::size_t y = 0; y < layout.rows(); ++y) {
    squaresOf(solved.residualBefore().data() + y * layout.stride(), width,
              before_.data() + y * width);
    squaresOf(solved.residualAfter().data() + y * layout.stride(), width,
              after_.data() + y * width);
  }
  boxMeans(before_, layout.size(), kResidualRadius, rows_);
  boxMeans(after_, layout.size(), kResidualRadius, rows_);
  trustResiduals(before_.data(), after_.data(), pixels, std::max(kLeastSquare, noise_dn * noise_dn),
                 trust_.data());
}

/// Over cells, whose sums stand for those of their pixels.
void TrustMap::judgeNeighbourhood(SensorSize size) {
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
      trust_[y * width + x] *= does[y / kCell * columns + x / kCell];
    }
  }
}

void TrustMap::measure(const Input& input, const SceneLayout& layout,
                       const ResidualSolver& solved) {
  const SensorSize size = layout.size();
  explain(layout, solved, input.noise_dn);
  findContradictions(input, layout, solved.solution());
  judgeNeighbourhood(size);
  boxMeans(contradicts_, size, kNearRadius, rows_);
  distrust(contradicts_.data(), contradicts_.size(), kNear, trust_.data());
  boxMeans(trust_, size, kNearRadius, rows_);
  for (float& trust : trust_) {
    trust = trust < kLeastTrust ? 0.0F : trust;
  }
}

std::size_t TrustMap::memoryBytes() const {
  std::size_t floats = could_.capacity() + does_.capacity();
  for (const std::vector<float>* plane : {&log_scene_, &padded_change_, &contradicts_, &comparable_,
                                          &before_, &after_, &rows_, &trust_}) {
    floats += plane->capacity();
  }
  return floats * sizeof(float);
}

}  // namespace fast_edi
