#include "fast_edi/base/level_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kTick = kIntervalTick_ns;

TEST(LevelModel, IsTheStaircaseByDefault) {
  const LevelModel staircase;
  EXPECT_TRUE(staircase.isStaircase());
  EXPECT_EQ(staircase.mostTicks(), 0);
  EXPECT_EQ(staircase.rampBefore(1000), 0);
  EXPECT_EQ(staircase.reached(0, 1000), 0.0);
  EXPECT_EQ(staircase.reached(-1, 1000), 1.0);
  EXPECT_TRUE((LevelModel{kTick - 1, 0.85}).isStaircase());
  EXPECT_TRUE((LevelModel{100 * kTick, 0.0}).isStaircase());
  EXPECT_FALSE((LevelModel{kTick, 0.01}).isStaircase());
}

TEST(LevelModel, GoesLinearlyTowardsAnEventAndTheRestAtIt) {
  const LevelModel level{100 * kTick + kTick / 2, 0.8};
  EXPECT_EQ(level.mostTicks(), 100);
  // Longer ago than tau: the ramp is tau.
  EXPECT_EQ(level.rampBefore(UINT16_MAX), 100 * kTick);
  EXPECT_EQ(level.reached(101 * kTick, UINT16_MAX), 0.0);
  EXPECT_EQ(level.reached(100 * kTick, UINT16_MAX), 0.0);
  EXPECT_DOUBLE_EQ(level.reached(75 * kTick, UINT16_MAX), 0.2);
  EXPECT_DOUBLE_EQ(level.reached(0, UINT16_MAX), 0.8);
  EXPECT_EQ(level.reached(-1, UINT16_MAX), 1.0);
  // Sooner after the event before: all of the time between.
  EXPECT_EQ(level.rampBefore(40), 40 * kTick);
  EXPECT_EQ(level.reached(40 * kTick, 40), 0.0);
  EXPECT_DOUBLE_EQ(level.reached(10 * kTick, 40), 0.6);
  EXPECT_EQ(level.reached(0, 0), 0.0);
}

TEST(LevelModel, TheLongestRampIsTheLongestIntervalThatIsKept) {
  EXPECT_EQ((LevelModel{kLongestRamp_ns, 1.0}).mostTicks(), UINT16_MAX);
  EXPECT_EQ((LevelModel{2 * kLongestRamp_ns, 1.0}).mostTicks(), UINT16_MAX);
}

TEST(LevelModel, ExcessIsTheMeanOfTheValueOverARampLessOne) {
  for (const double rise :
       {-9.0, -2.0, -0.5000001, -0.5, -0.2, -1e-9, 1e-9, 0.2, 0.5, 0.5000001, 2.0, 9.0}) {
    // By the trapezoidal rule.
    constexpr int kSteps = 20'000;
    long double sum = 0.5L * (1.0L + std::exp(static_cast<long double>(rise)));
    for (int i = 1; i < kSteps; ++i) {
      sum += std::exp(static_cast<long double>(rise) * i / kSteps);
    }
    const double mean = static_cast<double>(sum / kSteps);
    EXPECT_NEAR(LevelModel::excess(rise), mean - 1.0, 1e-7 * mean) << rise;
  }
  EXPECT_EQ(LevelModel::excess(0.0), 0.0);
  EXPECT_NEAR(LevelModel::excess(1e-9), 0.5e-9, 1e-18);
}

}  // namespace
}  // namespace fast_edi
