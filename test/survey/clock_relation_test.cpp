// Clocks compared by the times of recording, with the delays that recording has.
#include "survey/clock_relation.hpp"

#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "fast_edi/base/types.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kStart = 1'600'000'000 * kNanosecondsPerSecond;

using Clock = std::function<std::int64_t(std::int64_t t_ns)>;

/// Messages every \p period_ms for one second, recorded 5 to 25 ms after the instants they mean.
std::vector<ClockReading> readings(std::int64_t period_ms, const Clock& clock) {
  std::vector<ClockReading> result;
  std::mt19937 random(1);
  for (std::int64_t t_ms = 0; t_ms < 1000; t_ms += period_ms) {
    const std::int64_t t_ns = kStart + t_ms * kMs;
    result.push_back(
        {clock(t_ns), t_ns + 5 * kMs + static_cast<std::int64_t>(random() % 20) * kMs});
  }
  return result;
}

ClockRelation relate(const Clock& frames) {
  return *relateClocks(readings(40, frames), readings(10, [](std::int64_t t) { return t; }));
}

TEST(ClockRelationTest, OneClockHasNoOffsetAndOneRate) {
  const ClockRelation relation = relate([](std::int64_t t) { return t; });
  EXPECT_NEAR(static_cast<double>(relation.offset_ns), 0.0, 15.0 * kMs);
  EXPECT_FALSE(relation.ratesDiffer());
  EXPECT_EQ(relation.factor, 1);
}

TEST(ClockRelationTest, AnOffsetIsEventsMinusFrames) {
  const ClockRelation relation = relate([](std::int64_t t) { return t - 5000 * kMs; });
  EXPECT_NEAR(static_cast<double>(relation.offset_ns), 5000.0 * kMs, 15.0 * kMs);
  EXPECT_FALSE(relation.ratesDiffer());
}

TEST(ClockRelationTest, MultipliedStampsAreNamed) {
  const ClockRelation doubled = relate([](std::int64_t t) { return 2 * t; });
  EXPECT_NEAR(doubled.rate, 2.0, 0.1);
  EXPECT_EQ(doubled.factor, 2);
  EXPECT_FALSE(doubled.divided);
  EXPECT_TRUE(doubled.exact);
  EXPECT_EQ(doubled.undone(2 * kStart), kStart);
  const ClockRelation milliseconds = relate([](std::int64_t t) { return t / 1000; });
  EXPECT_EQ(milliseconds.factor, 1000);
  EXPECT_TRUE(milliseconds.divided);
  EXPECT_TRUE(milliseconds.exact);
  EXPECT_EQ(milliseconds.undone(kStart / 1000), kStart);
}

TEST(ClockRelationTest, TimeSinceTheStartMayHaveBeenMultiplied) {
  const ClockRelation relation = relate([](std::int64_t t) { return kStart + 3 * (t - kStart); });
  EXPECT_EQ(relation.factor, 3);
  EXPECT_FALSE(relation.exact);
}

TEST(ClockRelationTest, ARateThatIsNoSimpleNumberIsGivenAsItIs) {
  const ClockRelation relation =
      relate([](std::int64_t t) { return kStart + (t - kStart) * 14 / 10; });
  EXPECT_NEAR(relation.rate, 1.4, 0.1);
  EXPECT_EQ(relation.factor, 1);
  EXPECT_FALSE(relation.exact);
}

TEST(ClockRelationTest, TooFewMessagesTellNoRate) {
  const std::vector<ClockReading> arrays = readings(10, [](std::int64_t t) { return t; });
  EXPECT_FALSE(relateClocks({}, arrays));
  EXPECT_FALSE(relateClocks(arrays, {}));
  const auto doubled = readings(400, [](std::int64_t t) { return 2 * t; });
  ASSERT_EQ(doubled.size(), 3u);
  EXPECT_FALSE(relateClocks(doubled, arrays)->ratesDiffer());
}

}  // namespace
}  // namespace fast_edi
