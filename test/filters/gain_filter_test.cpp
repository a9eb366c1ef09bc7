#include "fast_edi/filters/gain_filter.hpp"
#include "fast_edi/integral/gain_limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "fast_edi/integral/double_integral.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{40, 30};

std::size_t indexOf(int x, int y) {
  return static_cast<std::size_t>(y * kSize.width + x);
}

constexpr ContrastThresholds kThresholds{0.25, 0.25};

std::vector<float> unitGains() {
  return std::vector<float>(kSize.pixelCount(), 1.0F);
}

/// Filters gains of a grey frame with given counts of OFF and ON events.
struct Fixture {
  std::vector<float> level = std::vector<float>(kSize.pixelCount(), 120.0F);
  std::vector<std::uint16_t> counts = std::vector<std::uint16_t>(2 * kSize.pixelCount());

  void setEvents(std::uint16_t off, std::uint16_t on) {
    for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
      counts[2 * i] = off;
      counts[2 * i + 1] = on;
    }
  }
  void apply(GainFilter& filter, std::vector<float>& gain) const {
    filter.apply(level.data(), {counts.data(), kThresholds}, gain.data());
  }
};

GainFilter::Settings nothing() {
  GainFilter::Settings settings;
  settings.despeckle = false;
  settings.smooth = false;
  settings.restore = 0.0F;
  return settings;
}

TEST(GainFilter, LeavesAFrameWithoutEventsExactlyAsItIs) {
  GainFilter filter(kSize, {});
  std::vector<float> gain = unitGains();
  Fixture{}.apply(filter, gain);
  EXPECT_EQ(gain, unitGains());
}

TEST(GainFilter, HotPixelsLeaveNoSpeck) {
  for (const float speck : {1e-30F, 0.2F, 5.0F, 1e30F}) {
    GainFilter filter(kSize, {});
    std::vector<float> gain = unitGains();
    Fixture f;
    for (const std::size_t pixel : {indexOf(20, 15), indexOf(21, 15)}) {
      gain[pixel] = speck;
      f.counts[2 * pixel + 1] = 40;
    }
    f.apply(filter, gain);
    EXPECT_EQ(gain, unitGains()) << speck;
  }
}

TEST(GainFilter, AThinLineOfTrueEventsStays) {
  GainFilter filter(kSize, {});
  std::vector<float> gain = unitGains();
  Fixture f;
  for (int y = 0; y < kSize.height; ++y) {
    gain[indexOf(12, y)] = 2.0F;
    f.counts[2 * indexOf(12, y)] = 3;
    f.counts[2 * indexOf(12, y) + 1] = 3;
  }
  f.apply(filter, gain);
  for (int y = 0; y < kSize.height; ++y) {
    EXPECT_GT(gain[indexOf(12, y)], 1.9F) << y;
    EXPECT_NEAR(gain[indexOf(10, y)], 1.0F, 0.02F) << y;
  }
}

TEST(GainFilter, SmoothingLeavesAStrongEdgeAsItIs) {
  GainFilter::Settings settings = nothing();
  settings.smooth = true;
  GainFilter filter(kSize, settings);
  std::vector<float> gain = unitGains();
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 20; x < kSize.width; ++x) {
      gain[indexOf(x, y)] = 4.0F;
    }
  }
  const std::vector<float> before = gain;
  Fixture f;
  f.setEvents(2, 2);
  f.apply(filter, gain);
  for (std::size_t i = 0; i < gain.size(); ++i) {
    EXPECT_NEAR(gain[i], before[i], 1e-5F) << i;
  }
}

TEST(GainFilter, LowersTheNoiseOfEvents) {
  GainFilter filter(kSize, {});
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0F, 0.06F);  // about what thresholds of 0.25 leave
  std::vector<float> gain = unitGains();
  double before = 0.0;
  for (float& value : gain) {
    const float log_gain = noise(random);
    before += static_cast<double>(log_gain) * static_cast<double>(log_gain);
    value = std::exp(log_gain);
  }
  Fixture f;
  f.setEvents(5, 5);
  f.apply(filter, gain);
  double after = 0.0;
  for (const float value : gain) {
    after += std::pow(std::log(static_cast<double>(value)), 2);
  }
  EXPECT_LT(after, 0.3 * before);
}

TEST(GainFilter, RaisesGainsOfFewEventsMost) {
  GainFilter::Settings settings = nothing();
  settings.restore = 0.4F;
  GainFilter filter(kSize, settings);
  float raised_before = 1.0F;
  for (const std::uint16_t on : {40, 10, 5, 2, 0}) {
    std::vector<float> gain(kSize.pixelCount(), std::exp(0.5F));
    Fixture f;
    f.setEvents(0, on);
    f.apply(filter, gain);
    const float raised = std::log(gain[0]) / 0.5F;
    EXPECT_GE(raised, raised_before);
    raised_before = raised;
    const float n = static_cast<float>(on) / 5.0F;
    EXPECT_NEAR(raised, 1.0F + 0.4F / (1.0F + n * n), 1e-4F);
  }
}

TEST(GainFilter, RestoredGainsStayWithinTheRangeOfExponentials) {
  GainFilter::Settings settings = nothing();
  settings.restore = 0.5F;
  GainFilter filter(kSize, settings);
  std::vector<float> gain = unitGains();
  gain[0] = std::exp(60.0F);
  gain[1] = std::exp(-60.0F);
  gain[2] = std::exp(45.0F);
  Fixture{}.apply(filter, gain);
  EXPECT_NEAR(std::log(gain[0]), 69.0F, 1e-4F);
  EXPECT_NEAR(std::log(gain[1]), -69.0F, 1e-4F);
  EXPECT_NEAR(std::log(gain[2]), 67.5F, 1e-4F);
}

/// The noise that is told to non-local means grows with the events, up to a count.
TEST(GainFilter, SmoothsByTheNoiseOfTheEvents) {
  GainFilter::Settings settings = nothing();
  settings.smooth = true;
  settings.noise = 0.3F;
  settings.spatial_sigma_px = 1.2F;
  GainFilter filter(kSize, settings);
  std::mt19937 random(9);
  std::normal_distribution<float> noise(0.0F, 0.12F);
  std::vector<float> gain;
  std::vector<float> expected;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    expected.push_back(noise(random));
    gain.push_back(std::exp(expected.back()));
  }
  Fixture f;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      f.counts[2 * indexOf(x, y)] = static_cast<std::uint16_t>(x + random() % 3);
      f.counts[2 * indexOf(x, y) + 1] = static_cast<std::uint16_t>(random() % 3);
    }
  }
  const ContrastThresholds thresholds{0.3, 0.2};
  filter.apply(f.level.data(), {f.counts.data(), thresholds}, gain.data());
  std::vector<float> variance;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    const float least = std::pow(0.3F * 0.25F, 2.0F);
    variance.push_back(least * (1.0F + std::min(filter.meanCounts()[i], 30.0F) / 15.0F));
  }
  NonLocalMeans(kSize, {2, 1.2F, 1}).apply(expected.data(), variance.data(), expected.data());
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    ASSERT_NEAR(std::log(gain[i]), expected[i], 1e-5F) << i;
  }
}

TEST(GainFilter, CountsAreAveragedOverNeighbours) {
  GainFilter filter(kSize, {});
  std::vector<float> gain = unitGains();
  Fixture f;
  f.counts[2 * indexOf(5, 5)] = 4;
  f.counts[2 * indexOf(5, 5) + 1] = 5;
  f.counts[2 * indexOf(0, 0)] = 1;
  f.apply(filter, gain);
  const float* means = filter.meanCounts();
  for (int y = 4; y <= 6; ++y) {
    for (int x = 4; x <= 6; ++x) {
      EXPECT_FLOAT_EQ(means[indexOf(x, y)], 1.0F);
    }
  }
  EXPECT_EQ(means[indexOf(7, 5)], 0.0F);
  EXPECT_EQ(means[indexOf(5, 3)], 0.0F);
  EXPECT_FLOAT_EQ(means[indexOf(0, 0)], 4.0F / 9.0F);  // the border counts twice
  EXPECT_FLOAT_EQ(means[indexOf(1, 0)], 2.0F / 9.0F);
  EXPECT_FLOAT_EQ(means[indexOf(1, 1)], 1.0F / 9.0F);
}

TEST(GainFilter, EachPieceCanBeSwitchedOff) {
  GainFilter filter(kSize, nothing());
  std::vector<float> gain = unitGains();
  gain[indexOf(5, 5)] = 3.0F;
  Fixture f;
  f.counts[2 * indexOf(5, 5)] = 40;
  f.apply(filter, gain);
  EXPECT_NEAR(gain[indexOf(5, 5)], 3.0F, 3e-6F);
  EXPECT_EQ(gain[indexOf(6, 5)], 1.0F);
}

TEST(GainFilter, StaysFiniteAtTheLimitsOfGains) {
  GainFilter filter(kSize, {});
  std::mt19937 random(5);
  std::vector<float> gain = unitGains();
  for (float& value : gain) {
    value = static_cast<float>(random() % 2 == 0 ? kMinGain : kMaxGain);
  }
  Fixture f;
  f.setEvents(65535, 65535);
  f.apply(filter, gain);
  for (const float value : gain) {
    EXPECT_TRUE(std::isfinite(value));
    EXPECT_GT(value, 0.0F);
  }
}

TEST(GainFilter, TakesSensorsOfAnySize) {
  for (const SensorSize size : {SensorSize{1, 1}, SensorSize{2, 7}, SensorSize{3, 3}}) {
    GainFilter::Settings settings;
    settings.restore = 0.0F;
    GainFilter filter(size, settings);
    std::vector<float> gain(size.pixelCount(), 1.5F);
    const std::vector<float> level(size.pixelCount(), 10.0F);
    const std::vector<std::uint16_t> counts(2 * size.pixelCount(), 1);
    filter.apply(level.data(), {counts.data(), kThresholds}, gain.data());
    for (const float value : gain) {
      EXPECT_NEAR(value, 1.5F, 1e-6F);
    }
  }
}

TEST(GainFilter, RefusesSettingsOutOfRange) {
  GainFilter::Settings settings;
  settings.noise = 0.0F;
  EXPECT_THROW(GainFilter(kSize, settings), std::invalid_argument);
  settings = {};
  settings.restore = 1.1F;
  EXPECT_THROW(GainFilter(kSize, settings), std::invalid_argument);
  settings.restore = -0.1F;
  EXPECT_THROW(GainFilter(kSize, settings), std::invalid_argument);
  for (const float bound : {0.0F, 1.0F}) {
    settings.restore = bound;
    EXPECT_NO_THROW(GainFilter(kSize, settings)) << bound;
  }
  settings = {};
  settings.spatial_sigma_px = -1.0F;
  EXPECT_THROW(GainFilter(kSize, settings), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
