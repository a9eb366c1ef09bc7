#include "fast_edi/core/gain_restoration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "fast_edi/core/double_integral.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{41, 29};
constexpr float kStrength = 0.35F;

std::size_t indexOf(SensorSize size, int x, int y) {
  return static_cast<std::size_t>(y * size.width + x);
}

std::vector<float> noise(SensorSize size, float mean, float sigma) {
  std::mt19937 random(11);
  std::normal_distribution<float> normal(mean, sigma);
  std::vector<float> plane(size.pixelCount());
  for (float& value : plane) {
    value = normal(random);
  }
  return plane;
}

/// The header's formula, word for word, in double.
double slowRestoration(const std::vector<float>& plane, SensorSize size, double strength, int x,
                       int y) {
  const int r = GainRestoration::kRadius;
  double sum = 0.0;
  int count = 0;
  for (int v = std::max(0, y - r); v <= std::min(size.height - 1, y + r); ++v) {
    for (int u = std::max(0, x - r); u <= std::min(size.width - 1, x + r); ++u) {
      sum += static_cast<double>(plane[indexOf(size, u, v)]);
      ++count;
    }
  }
  const auto g = static_cast<double>(plane[indexOf(size, x, y)]);
  const double part = std::min(std::max(g - sum / count, std::min(g, 0.0)), std::max(g, 0.0));
  const double c = std::min(std::max(part, -0.35), 0.35);
  return g + strength * c * c * c / (c * c + 0.055 * 0.055);
}

TEST(GainRestoration, FollowsItsFormula) {
  for (const SensorSize size : {kSize, SensorSize{7, 60}, SensorSize{60, 5}, SensorSize{1, 1}}) {
    for (const float mean : {0.0F, 0.4F, -0.2F}) {
      const std::vector<float> before = noise(size, mean, 0.3F);
      std::vector<float> after = before;
      GainRestoration(size, kStrength).apply(after.data());
      for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
          ASSERT_NEAR(after[indexOf(size, x, y)], slowRestoration(before, size, kStrength, x, y),
                      2e-5)
              << x << ", " << y;
        }
      }
    }
  }
}

TEST(GainRestoration, APixelWithoutGainStaysWithoutWhateverItsNeighboursDo) {
  std::vector<float> plane = noise(kSize, 0.5F, 1.0F);
  for (std::size_t i = 0; i < plane.size(); i += 3) {
    plane[i] = 0.0F;
  }
  GainRestoration(kSize, kStrength).apply(plane.data());
  for (std::size_t i = 0; i < plane.size(); i += 3) {
    EXPECT_EQ(plane[i], 0.0F) << i;
  }
}

TEST(GainRestoration, AGainThatIsTheSameAllOverStays) {
  for (const float gain : {-1.3F, -0.1F, 0.7F, 3.0F}) {
    std::vector<float> plane(kSize.pixelCount(), gain);
    GainRestoration(kSize, kStrength).apply(plane.data());
    for (const float value : plane) {
      EXPECT_NEAR(value, gain, 1e-6F);
    }
  }
}

TEST(GainRestoration, RaisesFineStructureAndHardlyAnyNoise) {
  const auto raised_by = [](float amplitude) {
    std::vector<float> plane(kSize.pixelCount());
    for (std::size_t i = 0; i < plane.size(); ++i) {
      plane[i] = i % 2 == 0 ? amplitude : -amplitude;  // width is odd: a chequerboard
    }
    GainRestoration(kSize, kStrength).apply(plane.data());
    return plane[indexOf(kSize, 20, 14)] / amplitude;
  };
  EXPECT_NEAR(raised_by(0.3F), 1.0F + kStrength, 0.02F);
  EXPECT_LT(raised_by(0.02F), 1.05F);
}

TEST(GainRestoration, AStrongEdgeGrowsByNoMoreThanItsLimit) {
  std::vector<float> plane(kSize.pixelCount());
  for (int y = 0; y < kSize.height; ++y) {
    std::fill_n(plane.begin() + y * kSize.width + 20, kSize.width - 20, 2.0F);
  }
  GainRestoration(kSize, kStrength).apply(plane.data());
  for (int x = 0; x < kSize.width; ++x) {
    const float gain = plane[indexOf(kSize, x, 14)];
    EXPECT_GE(gain, x < 20 ? 0.0F : 2.0F) << x;
    EXPECT_LE(gain, x < 20 ? 0.0F : 2.0F + kStrength * 0.35F) << x;
  }
}

TEST(GainRestoration, TurnsNoSignAndRaisesByNoMoreThanItsStrength) {
  const std::vector<float> before = noise(kSize, 0.1F, 2.0F);
  std::vector<float> after = before;
  GainRestoration(kSize, kStrength).apply(after.data());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GE(std::fabs(after[i]), std::fabs(before[i]) * (1.0F - 1e-6F));
    EXPECT_LE(std::fabs(after[i]), std::fabs(before[i]) * (1.0F + kStrength + 1e-6F));
    EXPECT_EQ(std::signbit(after[i]), std::signbit(before[i]));
  }
}

TEST(GainRestoration, StaysFiniteAtTheLimitsOfGains) {
  const auto limit = static_cast<float>(std::log(DoubleIntegral::kMaxGain));
  for (const bool mixed : {false, true}) {
    std::vector<float> plane(kSize.pixelCount(), limit);
    for (std::size_t i = 0; mixed && i < plane.size(); i += 2) {
      plane[i] = -limit;
    }
    GainRestoration(kSize, GainRestoration::kMaxStrength).apply(plane.data());
    for (const float value : plane) {
      EXPECT_TRUE(std::isfinite(std::exp(value)));
      EXPECT_GT(std::exp(value), 0.0F);
    }
  }
}

TEST(GainRestoration, WithoutStrengthDoesNothing) {
  const std::vector<float> before = noise(kSize, 0.1F, 1.0F);
  std::vector<float> after = before;
  GainRestoration(kSize, 0.0F).apply(after.data());
  EXPECT_EQ(after, before);
}

TEST(GainRestoration, RefusesAStrengthOutOfRange) {
  for (const float strength : {-0.1F, 1.1F, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_THROW(GainRestoration(kSize, strength), std::invalid_argument) << strength;
  }
}

}  // namespace
}  // namespace fast_edi
