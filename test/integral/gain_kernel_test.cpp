#include "integral/gain_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/integral/gain_limits.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;

constexpr IntervalClock kBefore{1000.0, 16'000.0};
constexpr IntervalClock kAfter{-500.0, 14'000.0};

/// The equation of gain_kernel.hpp for one pixel.
float plainGain(const PixelSums& before, const PixelSums& after) {
  const double a = before.sum + before.value * kBefore.end - kBefore.start;
  const double b = after.sum + after.value * kAfter.end - kAfter.start;
  const double integral = a + before.value * b;
  const double ratio = (kBefore.length() + kAfter.length()) * before.value / integral;
  if (std::isnan(integral) || integral <= 0.0 || std::isnan(ratio) || ratio < 0.0) {
    return kOutOfRange;
  }
  return static_cast<float>(std::clamp(ratio, kMinGain, kMaxGain));
}

struct Pixels {
  std::vector<PixelSums> before;
  std::vector<PixelSums> after;
};

std::vector<float> take(Pixels pixels) {
  const std::size_t count = pixels.before.size();
  std::vector<float> gain(count);
  takeGains({pixels.before.data(), kBefore}, {pixels.after.data(), kAfter}, count, gain.data());
  for (const std::vector<PixelSums>* sums : {&pixels.before, &pixels.after}) {
    for (const PixelSums& pixel : *sums) {
      EXPECT_EQ(pixel.sum, 0.0);
      EXPECT_EQ(pixel.value, 1.0);
    }
  }
  return gain;
}

TEST(GainKernel, EqualsTheEquationToTheBit) {
  std::mt19937 random(1);
  const auto any = [&random] { return static_cast<double>(random()) / std::mt19937::max(); };
  for (std::size_t count = 0; count <= 11; ++count) {
    Pixels pixels;
    for (std::size_t i = 0; i < count; ++i) {
      pixels.before.push_back({20'000.0 * (any() - 0.5), std::exp(4.0 * (any() - 0.5))});
      pixels.after.push_back({20'000.0 * (any() - 0.5), std::exp(4.0 * (any() - 0.5))});
    }
    const std::vector<float> gain = take(pixels);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(gain[i], plainGain(pixels.before[i], pixels.after[i])) << i << " of " << count;
    }
  }
}

TEST(GainKernel, TellsPixelsWithoutAGainAndBoundsTheOthersAtEachPlaceOfAStride) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<PixelSums> extremes{{0.0, 0.0},       {0.0, kInfinity},  {0.0, kNaN},
                                        {kInfinity, 1.0}, {-kInfinity, 1.0}, {kNaN, 1.0},
                                        {-1e9, 1.0},      {0.0, -1.0},       {1e12, 1.0},
                                        {1e-3, 1e-12},    {-28'999.99, 1.0}, {0.0, 1e300}};
  for (const PixelSums& extreme : extremes) {
    for (std::size_t place = 0; place < 5; ++place) {
      Pixels pixels{std::vector<PixelSums>(5, PixelSums{0.0, 1.0}),
                    std::vector<PixelSums>(5, PixelSums{0.0, 1.0})};
      pixels.before[place] = extreme;
      std::vector<float> expected(5, 1.0F);
      expected[place] = plainGain(extreme, {0.0, 1.0});
      EXPECT_EQ(take(pixels), expected) << extreme.sum << ", " << extreme.value << " at " << place;
    }
  }
}

TEST(GainKernel, ReplacesAndCountsWhatIsOutOfRange) {
  std::vector<float> gain{2.0F, kOutOfRange, 0.5F, kOutOfRange};
  EXPECT_EQ(replaceOutOfRange(gain.size(), gain.data()), 2U);
  EXPECT_THAT(gain, ElementsAre(2.0F, 1.0F, 0.5F, 1.0F));
  EXPECT_EQ(replaceOutOfRange(gain.size(), gain.data()), 0U);
}

}  // namespace
}  // namespace fast_edi
