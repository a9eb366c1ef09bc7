// Filters by the traces that they leave in the times between events.
#include "fast_edi/validation/filter_checks.hpp"

#include <cmath>
#include <functional>
#include <random>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

constexpr double kMs = static_cast<double>(kNanosecondsPerMillisecond);
constexpr double kLong_ns = 100.0 * kMs;

/// Exponential times with a mean of 15 ms, as chance gives them.
TimeHistogram chanceTimes(const std::function<bool(double ms)>& kept) {
  TimeHistogram histogram;
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const double ms = -15.0 * std::log((random() % 1'000'000 + 0.5) * 1e-6);
    if (kept(ms)) {
      histogram.add(static_cast<std::int64_t>(ms * kMs));
    }
  }
  return histogram;
}

TEST(FilterChecksTest, ChanceHasNoEdges) {
  const TimeHistogram times = chanceTimes([](double) { return true; });
  EXPECT_FALSE(backgroundActivityEdgeNs(times, kLong_ns));
  EXPECT_FALSE(refractoryEdgeNs(times));
}

TEST(FilterChecksTest, ABackgroundActivityFilterBreaksTimesOff) {
  for (const double filter_ms : {2.0, 20.0}) {
    const auto edge_ns = backgroundActivityEdgeNs(
        chanceTimes([&](double ms) { return ms < filter_ms || std::fmod(ms, 1.0) < 0.15; }),
        kLong_ns);
    ASSERT_TRUE(edge_ns) << filter_ms;
    EXPECT_NEAR(*edge_ns / kMs, filter_ms, 0.15 * filter_ms);
  }
}

TEST(FilterChecksTest, APeakIsNotAFilter) {
  TimeHistogram times = chanceTimes([](double) { return true; });
  for (int i = 0; i < 2000; ++i) {
    times.add(static_cast<std::int64_t>(10.0 * kMs));  // flickering light
  }
  EXPECT_FALSE(backgroundActivityEdgeNs(times, kLong_ns));
}

TEST(FilterChecksTest, ARefractoryFilterLetsTimesSetInAtOnce) {
  const auto edge_ns = refractoryEdgeNs(chanceTimes([](double ms) { return ms >= 1.0; }));
  ASSERT_TRUE(edge_ns);
  EXPECT_NEAR(*edge_ns / kMs, 1.0, 0.1);
  // A scene's own shortest times come up slowly.
  std::mt19937 random(1);
  EXPECT_FALSE(refractoryEdgeNs(chanceTimes([&](double ms) {
    return ms > 1.0 && (random() % 1000) * 1e-3 < std::pow((ms - 1.0) / 3.0, 2.0);
  })));
}

EventStatistics withPolarities(int on, int off) {
  EventStatistics statistics({64, 64});
  std::mt19937 random(1);
  std::int64_t t_ns = 0;
  for (int i = 0; i < on + off; ++i) {
    t_ns += static_cast<std::int64_t>(random() % 16'384);
    statistics.add({static_cast<std::uint16_t>(random() % 64),
                    static_cast<std::uint16_t>(random() % 64), t_ns, i < on});
  }
  return statistics;
}

TEST(FilterChecksTest, PolaritiesAreWeighed) {
  EXPECT_THAT(checkFilters(withPolarities(5'000, 4'000), kLong_ns), IsEmpty());
  EXPECT_THAT(checkFilters(withPolarities(9'000, 3'000), kLong_ns),
              ElementsAre(Field(&Finding::name, "polarity-imbalance")));
  EXPECT_THAT(checkFilters(withPolarities(9'000, 10), kLong_ns),
              ElementsAre(Field(&Finding::name, "polarity-missing")));
  EXPECT_TRUE(polarityIsMissing(withPolarities(10, 9'000)));
  EXPECT_FALSE(polarityIsMissing(withPolarities(3, 0)));
}

}  // namespace
}  // namespace fast_edi
