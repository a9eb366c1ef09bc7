#include "pipeline/window_integral.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"
#include "support/reference_double_integral.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{8, 6};
constexpr ExposureInterval kWindow{10 * kMs, 30 * kMs};
constexpr std::int64_t kMid = 20 * kMs;
constexpr auto kNotCounted = WindowIntegral::Counting::kNone;
constexpr auto kCounted = WindowIntegral::Counting::kWindow;

class WindowIntegralTest : public ::testing::Test {
 protected:
  WindowIntegralTest() {
    parameters.thresholds = {0.3, 0.25};
    parameters.filter.enabled = false;
  }

  void take(SensorSize size, std::uint64_t seed) {
    list = testing::makeEvents(testing::EventScene::kUniform, {size, 2000, 0, 40 * kMs, seed});
    events.take(testing::wireView(testing::toWire(list)), size, {});
  }
  void expectReference(SensorSize size) {
    const auto expected = testing::referenceDoubleIntegral(size, list, parameters.thresholds,
                                                           parameters.weighting, kWindow, kMid);
    ASSERT_EQ(integral.gains().size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_NEAR(integral.gains()[i], 1.0 / expected[i], 1e-4 / expected[i]) << "pixel " << i;
    }
  }

  DeblurParameters parameters;
  DeblurCounters counters;
  EventStream events{{}, counters, [](StreamReset, std::int64_t) {}};
  WindowIntegral integral;
  std::vector<Event> list;
};

TEST_F(WindowIntegralTest, TakesNoMemoryBeforeItMay) {
  take(kSize, 1);
  EXPECT_FALSE(integral.prepare(events, parameters, false));
  EXPECT_EQ(integral.memoryBytes(), 0u);
  EXPECT_TRUE(integral.prepare(events, parameters, true));
  EXPECT_GT(integral.memoryBytes(), 0u);
  EXPECT_TRUE(integral.prepare(events, parameters, false));
}

TEST_F(WindowIntegralTest, GivesTheGainsOfTheReferencePredictedOrNot) {
  take(kSize, 1);
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  EXPECT_EQ(integral.integrate(*events.lists(), kWindow, kMid, kNotCounted).kind,
            IntegrationKind::kNotPredicted);
  expectReference(kSize);
  const std::vector<float> gains = integral.gains();
  integral.predictWindow(kWindow, kMid);
  integral.accumulate(*events.lists(), kCounted);
  const IntegrationReport report = integral.integrate(*events.lists(), kWindow, kMid, kCounted);
  EXPECT_EQ(report.kind, IntegrationKind::kPredicted);
  EXPECT_EQ(integral.gains(), gains);
  std::uint64_t counted = 0;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    counted += integral.counts().on(i) + integral.counts().off(i);
  }
  EXPECT_EQ(counted, report.events);
}

TEST_F(WindowIntegralTest, APredictionNearTheOneBeforeKeepsTheRunningSums) {
  take(kSize, 1);
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  integral.predictWindow(kWindow, kMid);
  integral.accumulate(*events.lists(), kNotCounted);
  integral.predictWindow({kWindow.start_ns + 1000, kWindow.end_ns + 1000}, kMid + 1000);
  EXPECT_EQ(integral.integrate(*events.lists(), kWindow, kMid, kNotCounted).kind,
            IntegrationKind::kPredicted);
}

TEST_F(WindowIntegralTest, FollowsTheListsThroughAChangeOfSize) {
  take(kSize, 1);
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  integral.integrate(*events.lists(), kWindow, kMid, kCounted);
  const SensorSize larger{12, 10};
  take(larger, 2);
  EXPECT_FALSE(integral.prepare(events, parameters, false));
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  integral.integrate(*events.lists(), kWindow, kMid, kCounted);
  expectReference(larger);
}

TEST_F(WindowIntegralTest, StartsAnewAfterTheListsWereEmptied) {
  take(kSize, 1);
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  integral.predictWindow(kWindow, kMid);
  integral.accumulate(*events.lists(), kCounted);
  events.restart();
  take(kSize, 3);
  ASSERT_TRUE(integral.prepare(events, parameters, false));
  integral.integrate(*events.lists(), kWindow, kMid, kCounted);
  expectReference(kSize);
}

TEST_F(WindowIntegralTest, AdoptsThresholdsAndWeighting) {
  take(kSize, 1);
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  integral.predictWindow(kWindow, kMid);
  integral.accumulate(*events.lists(), kCounted);
  parameters.thresholds = {0.2, 0.4};
  integral.adopt(parameters);
  integral.integrate(*events.lists(), kWindow, kMid, kCounted);
  expectReference(kSize);
  parameters.weighting = Weighting::kCounter;
  integral.adopt(parameters);
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  integral.integrate(*events.lists(), kWindow, kMid, kCounted);
  expectReference(kSize);
}

TEST_F(WindowIntegralTest, CountsTheLaterQuartersOnlyForReblurring) {
  parameters.filter.enabled = true;
  EXPECT_EQ(WindowIntegral::countingFor(parameters), WindowIntegral::Counting::kQuarters);
  parameters.reference = ExposureInstant::kEnd;
  EXPECT_EQ(WindowIntegral::countingFor(parameters), WindowIntegral::Counting::kWindow);
  parameters.filter.enabled = false;
  EXPECT_EQ(WindowIntegral::countingFor(parameters), WindowIntegral::Counting::kNone);

  take(kSize, 1);
  ASSERT_TRUE(integral.prepare(events, parameters, true));
  integral.integrate(*events.lists(), kWindow, kMid, kCounted);
  const std::size_t bytes = integral.memoryBytes();
  integral.predictWindow({kWindow.start_ns + kMs, kWindow.end_ns + kMs}, kMid + kMs);
  integral.accumulate(*events.lists(), WindowIntegral::Counting::kQuarters);
  integral.integrate(*events.lists(), kWindow, kMid, WindowIntegral::Counting::kQuarters);
  EXPECT_GT(integral.memoryBytes(), bytes);
  std::size_t third = 0;
  std::size_t fourth = 0;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    third += integral.quarters().third().on(i) + integral.quarters().third().off(i);
    fourth += integral.quarters().fourth().on(i) + integral.quarters().fourth().off(i);
  }
  const auto expected = [this](std::int64_t from_ns, std::int64_t to_ns) {
    return static_cast<std::size_t>(std::count_if(
        list.begin(), list.end(),
        [=](const Event& event) { return event.t_ns >= from_ns && event.t_ns < to_ns; }));
  };
  EXPECT_EQ(third, expected(20 * kMs, 25 * kMs));
  EXPECT_EQ(fourth, expected(25 * kMs, 30 * kMs));
  integral.accumulate(*events.lists(), kCounted);
  EXPECT_EQ(integral.memoryBytes(), bytes);
}

}  // namespace
}  // namespace fast_edi
