// Filters by the traces that they leave in the times between events.
#include "validation/filter_checks.hpp"

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "simulation/davis_simulator.hpp"
#include "simulation/recording_faults.hpp"

namespace fast_edi {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;
using ::testing::Not;

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

TEST(FilterChecksTest, BurstsInStepWithTheFramesAreNoFilter) {
  // Neighbours that rested since the last burst of the whole sensor end their rest at the next one.
  std::mt19937 random(1);
  TimeHistogram times;
  for (int i = 0; i < 40'000; ++i) {
    const double ms = -25.0 * std::log((random() % 1'000'000 + 0.5) * 1e-6);
    const double rest_ms = ms > 48.0 && random() % 10 < 9 ? 48.0 : ms;
    times.add(static_cast<std::int64_t>(rest_ms * kMs));
    times.add(
        static_cast<std::int64_t>(kMs * std::exp2(static_cast<double>(random() % 900) / 100)));
  }
  EXPECT_FALSE(backgroundActivityEdgeNs(times, kLong_ns));
}

/// Noise of real sensors: leak events at 0.1 Hz, shot noise of 1 Hz in bright and 5 Hz in dim
/// light.
class NoisySensor : public ::testing::TestWithParam<double> {
 protected:
  static std::optional<double> edgeOf(double shot_hz, std::int64_t filter_us) {
    SimulationSettings settings;
    settings.sensor.size = {96, 72};
    settings.sensor.leak_rate_hz = 0.1;
    settings.sensor.shot_noise_bright_hz = shot_hz;
    settings.sensor.shot_noise_dark_hz = shot_hz;
    settings.motion.kind = MotionKind::kPan;
    settings.scene.texture = TextureKind::kNatural;
    settings.timing.frames = 20;
    settings.seed = 7;
    std::vector<Event> events = simulateSequence(settings).events;
    RecordingFaults faults;
    faults.background_activity_filter_us = filter_us;
    FaultyStream(faults, settings.sensor.size, settings.timing).apply({}, events);
    EventStatistics statistics(settings.sensor.size);
    for (const Event& event : events) {
      statistics.add(event);
    }
    return backgroundActivityEdgeNs(statistics.neighbourTimes(), kLong_ns);
  }
};

TEST_P(NoisySensor, IsNotTakenForAFilteredOne) {
  EXPECT_FALSE(edgeOf(GetParam(), 0));
}

TEST_P(NoisySensor, ShowsAFilter) {
  for (const std::int64_t filter_us : {2'000, 20'000}) {
    const auto edge_ns = edgeOf(GetParam(), filter_us);
    ASSERT_TRUE(edge_ns) << filter_us;
    EXPECT_NEAR(*edge_ns * 1e-3, static_cast<double>(filter_us), 0.15 * filter_us);
  }
}

INSTANTIATE_TEST_SUITE_P(ShotNoiseHz, NoisySensor, ::testing::Values(1.0, 5.0));

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

TEST(FilterChecksTest, HotPixelsWithABeatOfTheirOwnAreNoRefractoryFilter) {
  EventStatistics statistics({64, 64});
  std::mt19937 random(1);
  for (int i = 0; i < 4'000; ++i) {
    const std::int64_t t_ns = static_cast<std::int64_t>(i * 0.5 * kMs);
    statistics.add({static_cast<std::uint16_t>(20 + i % 2), 20, t_ns, true});  // 1 kHz each
    statistics.add({static_cast<std::uint16_t>(random() % 64),
                    static_cast<std::uint16_t>(random() % 64), t_ns, false});
  }
  EXPECT_TRUE(refractoryEdgeNs(statistics.pixelTimes()));
  EXPECT_LE(statistics.pixelsWithShortest(0.9 * kMs, 1.9 * kMs), 10U);
  EXPECT_THAT(checkFilters(statistics, kLong_ns, RecordingOrigin::kRosDriver),
              Not(Contains(Field(&Finding::name, "refractory-filter"))));
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
  EXPECT_THAT(checkFilters(withPolarities(5'000, 4'000), kLong_ns, RecordingOrigin::kRosDriver),
              IsEmpty());
  EXPECT_THAT(checkFilters(withPolarities(9'000, 3'000), kLong_ns, RecordingOrigin::kRosDriver),
              ElementsAre(Field(&Finding::name, "polarity-imbalance")));
  EXPECT_THAT(checkFilters(withPolarities(9'000, 10), kLong_ns, RecordingOrigin::kRosDriver),
              ElementsAre(Field(&Finding::name, "polarity-missing")));
  EXPECT_TRUE(polarityIsMissing(withPolarities(10, 9'000)));
  EXPECT_FALSE(polarityIsMissing(withPolarities(3, 0)));
}

}  // namespace
}  // namespace fast_edi
