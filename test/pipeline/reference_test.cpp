/// Checks the oracle by hand-worked examples, and the baselines against the oracle.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"
#include "support/paper_lists.hpp"
#include "support/reference_double_integral.hpp"
#include "support/vanilla_edi.hpp"

namespace fast_edi::testing {
namespace {

constexpr SensorSize kSize{24, 16};
constexpr ContrastThresholds kEqual{0.3, 0.3};
constexpr ContrastThresholds kUnequal{0.31, 0.24};
constexpr double kTolerance = 1e-9;

std::vector<double> ratios(const std::vector<double>& values, const std::vector<double>& expected) {
  std::vector<double> result;
  for (std::size_t i = 0; i < expected.size(); ++i) result.push_back(values[i] / expected[i]);
  return result;
}

void expectEqual(const std::vector<double>& values, const std::vector<double>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  const std::vector<double> ratio = ratios(values, expected);
  for (std::size_t i = 0; i < ratio.size(); ++i) ASSERT_NEAR(ratio[i], 1.0, kTolerance) << i;
}

std::vector<Event> randomEvents(std::uint64_t seed) {
  return makeEvents(EventScene::kUniform, {kSize, 5000, 7'000'000, 40'000'000, seed});
}

TEST(Reference, WeighsLevelsByElapsedTime) {
  // Levels 1, 2, 1 for 20, 30 and 50 of 100 ns, seen from the middle one.
  const ContrastThresholds doubling{std::log(2.0), std::log(2.0)};
  const std::vector<Event> events{{0, 0, 1020, true}, {0, 0, 1050, false}};
  const ExposureInterval window{1000, 1100};
  const auto value = [&](std::int64_t reference_ns) {
    return referenceDoubleIntegral({1, 1}, events, doubling, Weighting::kTime, window,
                                   reference_ns)[0];
  };
  EXPECT_DOUBLE_EQ(value(1000), (20 + 2 * 30 + 50) / 100.0);
  EXPECT_DOUBLE_EQ(value(1040), (20 + 2 * 30 + 50) / 100.0 / 2);
  EXPECT_DOUBLE_EQ(value(1100), (20 + 2 * 30 + 50) / 100.0);
}

TEST(Reference, WeighsLevelsByEventsAnywhere) {
  // Pixel 0 changes at counters 1 and 3 of 4: levels 1, 2, 1 count 1, 2 and 1 times.
  const ContrastThresholds doubling{std::log(2.0), std::log(2.0)};
  const std::vector<Event> events{
      {1, 0, 10, true}, {0, 0, 20, true}, {1, 0, 30, true}, {0, 0, 40, false}};
  const std::vector<double> value = referenceDoubleIntegral(
      {2, 1}, events, doubling, Weighting::kCounter, ExposureInterval{0, 100}, 0);
  EXPECT_DOUBLE_EQ(value[0], (1 + 2 * 2 + 1) / 4.0);
  EXPECT_DOUBLE_EQ(value[1], (2 * 2 + 4 * 2) / 4.0);
}

TEST(Reference, TakesTheStartInAndTheEndNot) {
  const ContrastThresholds doubling{std::log(2.0), std::log(2.0)};
  const ExposureInterval window{1000, 1100};
  for (const Weighting weighting : {Weighting::kTime, Weighting::kCounter}) {
    EXPECT_DOUBLE_EQ(referenceDoubleIntegral({1, 1}, {{0, 0, 1000, true}, {0, 0, 1100, true}},
                                             doubling, weighting, window, 1000)[0],
                     2.0);
  }
}

TEST(Reference, AnEventAtTheReferenceComesAfterIt) {
  const ContrastThresholds doubling{std::log(2.0), std::log(2.0)};
  const std::vector<Event> events{{0, 0, 1050, true}};
  const ExposureInterval window{1000, 1100};
  const auto value = [&](std::int64_t reference_ns) {
    return referenceDoubleIntegral({1, 1}, events, doubling, Weighting::kTime, window,
                                   reference_ns)[0];
  };
  EXPECT_DOUBLE_EQ(value(1050), 1.5);
  EXPECT_DOUBLE_EQ(value(1051), 0.75);
}

TEST(VanillaEdi, EqualsTheReferenceInCounterWeighting) {
  const std::vector<Event> events = randomEvents(3);
  const ExposureInterval window{12'000'000, 41'000'000};
  for (const std::int64_t reference_ns :
       {window.start_ns, window.start_ns + 13'000'000, window.end_ns}) {
    VanillaEdi vanilla(kSize, kEqual);
    vanilla.begin(window, reference_ns);
    for (const Event& event : events) vanilla.add(event);
    expectEqual(
        vanilla.doubleIntegral(),
        referenceDoubleIntegral(kSize, events, kEqual, Weighting::kCounter, window, reference_ns));
  }
}

TEST(VanillaEdi, StartsAnewWithEachFrame) {
  const std::vector<Event> events = randomEvents(4);
  VanillaEdi vanilla(kSize, kEqual);
  for (const ExposureInterval window :
       {ExposureInterval{8'000'000, 20'000'000}, ExposureInterval{20'000'000, 45'000'000}}) {
    vanilla.begin(window, window.at(ExposureInstant::kMid));
    vanilla.add(wireView(toWire(events)));
    expectEqual(vanilla.doubleIntegral(),
                referenceDoubleIntegral(kSize, events, kEqual, Weighting::kCounter, window,
                                        window.at(ExposureInstant::kMid)));
  }
}

TEST(PaperLists, EqualTheReferenceOverConsecutiveFrames) {
  const std::vector<Event> events = randomEvents(5);
  for (const Weighting weighting : {Weighting::kTime, Weighting::kCounter}) {
    for (const ContrastThresholds thresholds : {kEqual, kUnequal}) {
      PaperLists lists(kSize, thresholds, weighting);
      std::size_t next = 0;
      for (std::int64_t start_ns = 9'000'000; start_ns < 40'000'000; start_ns += 10'000'000) {
        const ExposureInterval window{start_ns, start_ns + 7'000'000};
        const std::int64_t reference_ns = window.at(ExposureInstant::kMid);
        // Events beyond the window have already come when it is closed.
        for (; next < events.size() && events[next].t_ns < window.end_ns + 2'000'000; ++next) {
          lists.add(events[next]);
        }
        expectEqual(
            lists.close(window, reference_ns),
            referenceDoubleIntegral(kSize, events, thresholds, weighting, window, reference_ns));
      }
    }
  }
}

TEST(PaperLists, WithoutEventsLeaveTheImageAlone) {
  PaperLists lists(kSize, kEqual, Weighting::kCounter);
  const std::vector<std::uint8_t> blurry = makeGreyImage(kSize, 1);
  std::vector<std::uint8_t> latent(blurry.size());
  lists.close({0, 1000}, 500, blurry.data(), latent.data());
  EXPECT_EQ(latent, blurry);
}

TEST(EventGenerators, StayOnTheSensorInTimeOrderAndRepeat) {
  const SensorSize size{80, 70};
  for (const EventScene scene :
       {EventScene::kUniform, EventScene::kMovingEdges, EventScene::kHotPixel, EventScene::kHotWalk,
        EventScene::kBursts, EventScene::kRandomWalks}) {
    SCOPED_TRACE(toString(scene));
    const EventSpec spec{size, 3001, 5'000'000'000, 40'000'000, 11};
    const std::vector<Event> events = makeEvents(scene, spec);
    ASSERT_EQ(events.size(), spec.count);
    EXPECT_EQ(toWire(makeEvents(scene, spec)), toWire(events));
    std::int64_t last_ns = spec.start_ns;
    for (const Event& event : events) {
      ASSERT_GE(event.t_ns, last_ns);
      ASSERT_LT(event.t_ns, spec.start_ns + spec.duration_ns);
      ASSERT_LT(event.x, size.width);
      ASSERT_LT(event.y, size.height);
      last_ns = event.t_ns;
    }
  }
}

}  // namespace
}  // namespace fast_edi::testing
