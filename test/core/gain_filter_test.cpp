#include "fast_edi/core/gain_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "fast_edi/core/double_integral.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{40, 30};

std::size_t indexOf(int x, int y) {
  return static_cast<std::size_t>(y * kSize.width + x);
}

std::vector<float> unitGains() {
  return std::vector<float>(kSize.pixelCount(), 1.0F);
}

TEST(GainFilter, LeavesAFrameWithoutEventsExactlyAsItIs) {
  GainFilter filter(kSize, {});
  std::vector<float> gain = unitGains();
  filter.apply(gain.data());
  EXPECT_EQ(gain, unitGains());
}

TEST(GainFilter, AHotPixelLeavesNoSpeck) {
  for (const float speck : {1e-30F, 0.2F, 5.0F, 1e30F}) {
    GainFilter filter(kSize, {});
    std::vector<float> gain = unitGains();
    gain[indexOf(20, 15)] = speck;
    filter.apply(gain.data());
    EXPECT_EQ(gain, unitGains()) << speck;
  }
}

TEST(GainFilter, AThinLineStays) {
  GainFilter::Settings settings;
  settings.smooth = false;
  settings.restore = 0.0F;
  GainFilter filter(kSize, settings);
  std::vector<float> gain = unitGains();
  for (int y = 0; y < kSize.height; ++y) {
    gain[indexOf(12, y)] = 2.0F;
  }
  filter.apply(gain.data());
  for (int y = 0; y < kSize.height; ++y) {
    EXPECT_NEAR(gain[indexOf(12, y)], 2.0F, 1e-6F) << y;
    EXPECT_EQ(gain[indexOf(11, y)], 1.0F) << y;
  }
}

TEST(GainFilter, SmoothingLeavesAStrongEdgeAsItIs) {
  GainFilter::Settings settings;
  settings.restore = 0.0F;
  GainFilter filter(kSize, settings);
  std::vector<float> gain = unitGains();
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 20; x < kSize.width; ++x) {
      gain[indexOf(x, y)] = 4.0F;  // ln 4 lies beyond the range's reach of sqrt(8) * 0.35
    }
  }
  const std::vector<float> before = gain;
  filter.apply(gain.data());
  for (std::size_t i = 0; i < gain.size(); ++i) {
    EXPECT_NEAR(gain[i], before[i], 1e-5F) << i;
  }
}

TEST(GainFilter, LowersTheNoiseOfEvents) {
  GainFilter filter(kSize, {});
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0F, 0.12F);  // about what thresholds of 0.25 leave
  std::vector<float> gain = unitGains();
  double before = 0.0;
  for (float& value : gain) {
    const float log_gain = noise(random);
    before += static_cast<double>(log_gain) * log_gain;
    value = std::exp(log_gain);
  }
  filter.apply(gain.data());
  double after = 0.0;
  for (const float value : gain) {
    after += std::pow(std::log(static_cast<double>(value)), 2);
  }
  EXPECT_LT(after, 0.25 * before);
}

TEST(GainFilter, EachPieceCanBeSwitchedOff) {
  GainFilter::Settings off;
  off.despeckle = false;
  off.smooth = false;
  off.restore = 0.0F;
  GainFilter filter(kSize, off);
  std::vector<float> gain = unitGains();
  gain[indexOf(5, 5)] = 3.0F;
  filter.apply(gain.data());
  EXPECT_NEAR(gain[indexOf(5, 5)], 3.0F, 3e-6F);
  EXPECT_EQ(gain[indexOf(6, 5)], 1.0F);
}

TEST(GainFilter, StaysFiniteAtTheLimitsOfGains) {
  GainFilter filter(kSize, {});
  std::mt19937 random(5);
  std::vector<float> gain = unitGains();
  for (float& value : gain) {
    value =
        static_cast<float>(random() % 2 == 0 ? DoubleIntegral::kMinGain : DoubleIntegral::kMaxGain);
  }
  filter.apply(gain.data());
  for (const float value : gain) {
    EXPECT_TRUE(std::isfinite(value));
    EXPECT_GT(value, 0.0F);
  }
}

TEST(GainFilter, TakesSensorsOfAnySize) {
  for (const SensorSize size : {SensorSize{1, 1}, SensorSize{2, 7}, SensorSize{3, 3}}) {
    GainFilter filter(size, {});
    std::vector<float> gain(size.pixelCount(), 1.5F);
    filter.apply(gain.data());
    for (const float value : gain) {
      EXPECT_NEAR(value, 1.5F, 1e-6F);
    }
  }
}

}  // namespace
}  // namespace fast_edi
