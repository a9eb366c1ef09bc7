#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/integral/gain_limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/event_generators.hpp"
#include "support/paper_lists.hpp"
#include "support/reference_double_integral.hpp"
#include "support/vanilla_edi.hpp"

namespace fast_edi {
namespace {

using testing::allocationCount;
using testing::EventScene;
using testing::EventSpec;
using testing::makeEvents;
using testing::referenceDoubleIntegral;
using testing::toWire;
using testing::wireView;

/// What the double integral promises against the oracle.
constexpr double kRelativeTolerance = 1e-4;

constexpr std::int64_t kMicrosecond = kNanosecondsPerMicrosecond;
constexpr std::int64_t kMillisecond = kNanosecondsPerMillisecond;
constexpr std::int64_t kStart = 1'600'000'000 * kNanosecondsPerSecond;
constexpr ContrastThresholds kUnequal{0.31, 0.24};
constexpr ContrastThresholds kEqual{0.3, 0.3};

/// How events count and what the level does between them.
struct Model {
  Weighting weighting;
  LevelModel level;
};
constexpr Model kTime{Weighting::kTime, {}};
constexpr Model kCounter{Weighting::kCounter, {}};
constexpr Model kRamps{Weighting::kTime, {4 * kMillisecond, 0.85}};
constexpr Model kModels[] = {kTime, kCounter, kRamps};

std::string toString(const Model& model) {
  return std::string(model.weighting == Weighting::kTime ? "time" : "counter") +
         (model.level.isStaircase() ? "" : "_ramps");
}

std::string modelName(const ::testing::TestParamInfo<Model>& model) {
  return toString(model.param);
}

class Lists : public PixelEventLists {
 public:
  Lists(SensorSize size, Limits limits) : PixelEventLists(size, limits) { keepIntervals(true); }
};

std::vector<double> referenceOf(const Model& model, SensorSize size,
                                const std::vector<Event>& events,
                                const ContrastThresholds& thresholds,
                                const ExposureInterval& window, std::int64_t reference_ns) {
  return referenceDoubleIntegral(size, events, thresholds, model.weighting, window, reference_ns,
                                 model.level);
}

/// 30 ms of a stream that lasts 40 ms; not at round numbers.
constexpr ExposureInterval kWindow{kStart + 5'123'000, kStart + 35'123'000};

void fill(PixelEventLists& lists, const std::vector<Event>& events) {
  const std::vector<std::uint8_t> wire = toWire(events);
  ASSERT_EQ(lists.append(wireView(wire)).consumed, events.size());
}

struct Closed {
  std::vector<float> gain;
  IntegrationReport report;
};

Closed closeWith(DoubleIntegral& integral, const PixelEventLists& lists,
                 const ExposureInterval& window, std::int64_t reference_ns) {
  // A value that close() never writes, so that a pixel left out shows.
  Closed closed{std::vector<float>(lists.size().pixelCount(), -1.0f), {}};
  closed.report = integral.integrate(lists, window, reference_ns, closed.gain.data());
  return closed;
}

/// Gains of a window that nobody announced, by an integral without a past.
Closed integrated(const PixelEventLists& lists, const ContrastThresholds& thresholds,
                  const Model& model, const ExposureInterval& window, std::int64_t reference_ns) {
  DoubleIntegral integral(lists.size(), thresholds, model.weighting, model.level);
  return closeWith(integral, lists, window, reference_ns);
}

void expectReciprocals(const std::vector<float>& gain, const std::vector<double>& expected) {
  ASSERT_EQ(gain.size(), expected.size());
  for (std::size_t i = 0; i < gain.size(); ++i) {
    const double expected_gain = std::min(std::max(1.0 / expected[i], kMinGain), kMaxGain);
    ASSERT_NEAR(gain[i] / expected_gain, 1.0, kRelativeTolerance)
        << "pixel " << i << ", E = " << expected[i];
  }
}

// Accuracy.

struct Scene {
  EventScene scene;
  SensorSize size;
  std::size_t events;
  ContrastThresholds thresholds;
};

class DoubleIntegralAccuracy : public ::testing::TestWithParam<std::tuple<Scene, Model, double>> {};

TEST_P(DoubleIntegralAccuracy, IsWithinTheToleranceOfTheReference) {
  const auto& [scene, model, reference_share] = GetParam();
  const std::vector<Event> events =
      makeEvents(scene.scene, {scene.size, scene.events, kStart, 40 * kMillisecond, 21});
  Lists lists(scene.size, {});
  fill(lists, events);
  const std::int64_t reference_ns =
      kWindow.start_ns +
      static_cast<std::int64_t>(reference_share * static_cast<double>(kWindow.length()));

  const Closed closed = integrated(lists, scene.thresholds, model, kWindow, reference_ns);
  EXPECT_EQ(closed.report.out_of_range, 0u);
  expectReciprocals(
      closed.gain, referenceOf(model, scene.size, events, scene.thresholds, kWindow, reference_ns));
}

std::string accuracyName(
    const ::testing::TestParamInfo<DoubleIntegralAccuracy::ParamType>& parameters) {
  const auto& [scene, model, reference_share] = parameters.param;
  return std::string(toString(scene.scene)) + "_" + toString(model) + "_reference_at_" +
         std::to_string(static_cast<int>(100 * reference_share));
}

constexpr SensorSize kSmall{86, 65};
constexpr SensorSize kOnePixel{1, 1};

INSTANTIATE_TEST_SUITE_P(
    Scenes, DoubleIntegralAccuracy,
    ::testing::Combine(
        ::testing::Values(Scene{EventScene::kUniform, {346, 260}, 400'000, kUnequal},
                          Scene{EventScene::kMovingEdges, {346, 260}, 400'000, kUnequal},
                          Scene{EventScene::kBursts, kSmall, 200'000, kUnequal},
                          Scene{EventScene::kRandomWalks, kSmall, 300'000, kUnequal},
                          Scene{EventScene::kHotPixel, kOnePixel, 1'400'000, kEqual},
                          Scene{EventScene::kHotWalk, kOnePixel, 1'400'000, {0.02, 0.02}}),
        ::testing::ValuesIn(kModels), ::testing::Values(0.0, 0.37, 0.5, 1.0)),
    accuracyName);

TEST(DoubleIntegral, WeighsCountersLikeVanillaEdiAndThePaper) {
  const SensorSize size{32, 24};
  for (const EventScene scene : {EventScene::kUniform, EventScene::kMovingEdges}) {
    SCOPED_TRACE(toString(scene));
    const std::vector<Event> events =
        makeEvents(scene, {size, 30'000, kStart, 40 * kMillisecond, 22});
    Lists lists(size, {});
    fill(lists, events);
    testing::VanillaEdi vanilla(size, kEqual);
    testing::PaperLists paper(size, kEqual, Weighting::kCounter);
    const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
    vanilla.begin(kWindow, reference_ns);
    for (const Event& event : events) {
      vanilla.add(event);
      paper.add(event);
    }
    const Closed closed = integrated(lists, kEqual, kCounter, kWindow, reference_ns);
    expectReciprocals(closed.gain, vanilla.doubleIntegral());
    expectReciprocals(closed.gain, paper.close(kWindow, reference_ns));
  }
}

// Borders.

class DoubleIntegralBorders : public ::testing::TestWithParam<Model> {};
INSTANTIATE_TEST_SUITE_P(Models, DoubleIntegralBorders, ::testing::ValuesIn(kModels), modelName);

TEST_P(DoubleIntegralBorders, AreHalfOpen) {
  const SensorSize size{4, 1};
  const std::int64_t mid_ns = kWindow.at(ExposureInstant::kMid);
  // Pixel 0: at start; 1: at end; 2: just before both; 3: at the reference and next to it.
  const std::vector<Event> events{
      {2, 0, kWindow.start_ns - 1, true}, {0, 0, kWindow.start_ns, true},
      {3, 0, mid_ns - 1, true},           {3, 0, mid_ns, true},
      {3, 0, mid_ns + 1, false},          {2, 0, kWindow.end_ns - 1, true},
      {1, 0, kWindow.end_ns, true}};
  Lists lists(size, {});
  fill(lists, events);
  for (const std::int64_t reference_ns :
       {kWindow.start_ns, kWindow.start_ns + 1, mid_ns - 1, mid_ns, mid_ns + 1, mid_ns + 2,
        kWindow.end_ns - 1, kWindow.end_ns}) {
    SCOPED_TRACE(reference_ns - kWindow.start_ns);
    const Closed closed = integrated(lists, kUnequal, GetParam(), kWindow, reference_ns);
    EXPECT_EQ(closed.report.events, 5u);
    EXPECT_EQ(closed.gain[1], 1.0f);
    expectReciprocals(closed.gain,
                      referenceOf(GetParam(), size, events, kUnequal, kWindow, reference_ns));
  }
}

TEST_P(DoubleIntegralBorders, HoldForEventsAroundThem) {
  // Every event lies within 2 us of an end, the reference or the middle of the window.
  const SensorSize size{5, 3};
  std::mt19937 random(4);
  const std::int64_t reference_ns = kWindow.start_ns + 11 * kMillisecond;
  const std::int64_t centres[] = {kWindow.start_ns, reference_ns, kWindow.at(ExposureInstant::kMid),
                                  kWindow.end_ns};
  std::vector<Event> events;
  for (const std::int64_t centre_ns : centres) {
    std::vector<std::int64_t> times;
    for (int i = 0; i < 40; ++i) times.push_back(centre_ns - 2000 + random() % 5 * 1000);
    std::sort(times.begin(), times.end());
    for (const std::int64_t t_ns : times) {
      events.push_back({static_cast<std::uint16_t>(random() % 5),
                        static_cast<std::uint16_t>(random() % 3), t_ns, random() % 2 == 0});
    }
  }
  Lists lists(size, {});
  fill(lists, events);
  for (const std::int64_t f_ns : {kWindow.start_ns, reference_ns, kWindow.end_ns}) {
    const Closed closed = integrated(lists, kUnequal, GetParam(), kWindow, f_ns);
    expectReciprocals(closed.gain, referenceOf(GetParam(), size, events, kUnequal, kWindow, f_ns));
  }
}

TEST_P(DoubleIntegralBorders, LeaveStillPixelsExactlyAlone) {
  const SensorSize size{20, 10};
  Lists lists(size, {});
  const std::vector<float> ones(size.pixelCount(), 1.0f);
  // Nothing at all; nothing inside; events in one pixel only.
  EXPECT_EQ(integrated(lists, kUnequal, GetParam(), kWindow, kWindow.start_ns).gain, ones);
  fill(lists, {{3, 3, kWindow.start_ns - 5, true}, {3, 3, kWindow.end_ns + 5, true}});
  const Closed outside = integrated(lists, kUnequal, GetParam(), kWindow, kWindow.end_ns);
  EXPECT_EQ(outside.gain, ones);
  EXPECT_EQ(outside.report.events, 0u);

  Lists busy(size, {});
  std::vector<Event> events =
      makeEvents(EventScene::kUniform, {{1, 1}, 5000, kStart, 40 * kMillisecond, 3});
  fill(busy, events);
  std::vector<float> gain =
      integrated(busy, kUnequal, GetParam(), kWindow, kWindow.at(ExposureInstant::kMid)).gain;
  EXPECT_NE(gain[0], 1.0f);
  gain[0] = 1.0f;
  EXPECT_EQ(gain, ones);
}

TEST_P(DoubleIntegralBorders, HoldEventsThatAllHaveOneTime) {
  const SensorSize size{6, 5};
  for (const std::int64_t t_ns : {kWindow.start_ns, kWindow.start_ns + 20 * kMicrosecond,
                                  kWindow.start_ns + 7 * kMillisecond, kWindow.end_ns - 1}) {
    std::vector<Event> events =
        makeEvents(EventScene::kUniform, {size, 2000, kStart, 40 * kMillisecond, 5});
    for (Event& event : events) event.t_ns = t_ns;
    Lists lists(size, {});
    fill(lists, events);
    for (const std::int64_t reference_ns : {kWindow.start_ns, t_ns, t_ns + 1, kWindow.end_ns}) {
      expectReciprocals(integrated(lists, kUnequal, GetParam(), kWindow, reference_ns).gain,
                        referenceOf(GetParam(), size, events, kUnequal, kWindow, reference_ns));
    }
  }
}

TEST_P(DoubleIntegralBorders, HoldForWindowsFromNanosecondsToSeconds) {
  const SensorSize size{6, 5};
  const std::vector<Event> events =
      makeEvents(EventScene::kUniform, {size, 20'000, kStart, 3000 * kMillisecond, 6});
  Lists lists(size, {});
  fill(lists, events);
  for (const std::int64_t length_ns :
       {std::int64_t{1}, std::int64_t{999}, 40 * kMicrosecond, 51 * kMicrosecond, kMillisecond,
        3 * kMillisecond, 1000 * kMillisecond, 2900 * kMillisecond}) {
    SCOPED_TRACE(length_ns);
    const std::int64_t start_ns = events[77].t_ns;
    const ExposureInterval window{start_ns, start_ns + length_ns};
    const std::int64_t reference_ns = window.at(ExposureInstant::kMid);
    expectReciprocals(integrated(lists, kUnequal, GetParam(), window, reference_ns).gain,
                      referenceOf(GetParam(), size, events, kUnequal, window, reference_ns));
  }
}

TEST_P(DoubleIntegralBorders, CountPixelsBeyondTheRangeOfDouble) {
  // Five thousand net events of one polarity, and back: e^1550 and e^-1200 have no double.
  const SensorSize size{3, 1};
  constexpr int kSteps = 5000;
  std::vector<Event> events;
  for (int i = 0; i < 2 * kSteps; ++i) {
    const std::int64_t t_ns = kWindow.start_ns + kMillisecond + i * kMicrosecond;
    events.push_back({0, 0, t_ns, i < kSteps});
    events.push_back({1, 0, t_ns, i >= kSteps});
  }
  events.push_back({2, 0, kWindow.end_ns - 10 * kMillisecond, true});
  Lists lists(size, {});
  fill(lists, events);
  for (const ExposureInstant reference :
       {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
    const Closed closed = integrated(lists, kUnequal, GetParam(), kWindow, kWindow.at(reference));
    EXPECT_EQ(closed.gain[0], 1.0f);
    EXPECT_EQ(closed.gain[1], 1.0f);
    EXPECT_EQ(closed.report.out_of_range, 2u);
    EXPECT_NE(closed.gain[2], 1.0f);
  }
}

TEST(DoubleIntegral, RefusesBadThresholds) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -0.1, kNan, kInfinity}) {
    EXPECT_THROW(DoubleIntegral({4, 4}, {bad, 0.2}, Weighting::kTime), std::invalid_argument);
    EXPECT_THROW(DoubleIntegral({4, 4}, {0.2, bad}, Weighting::kTime), std::invalid_argument);
  }
}

TEST(DoubleIntegral, TakesOverNewThresholds) {
  const std::vector<Event> events =
      makeEvents(EventScene::kUniform, {kSmall, 50'000, kStart, 40 * kMillisecond, 7});
  Lists lists(kSmall, {});
  fill(lists, events);
  const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
  DoubleIntegral integral(kSmall, kEqual, Weighting::kTime);
  integral.predictWindow(kWindow, reference_ns);
  integral.accumulate(lists);
  integral.setThresholds(kUnequal);
  EXPECT_EQ(integral.thresholds(), kUnequal);
  EXPECT_EQ(closeWith(integral, lists, kWindow, reference_ns).gain,
            integrated(lists, kUnequal, kTime, kWindow, reference_ns).gain);
}

// However a window was closed, the gains are the same, bit for bit.

class DoubleIntegralPaths : public ::testing::TestWithParam<Model> {
 protected:
  static constexpr SensorSize kPathSize{64, 48};
  static constexpr std::size_t kEvents = 200'000;

  DoubleIntegralPaths()
      : wire_(toWire(makeEvents(EventScene::kUniform,
                                {kPathSize, kEvents, kStart, 40 * kMillisecond, 31}))) {}

  /// Integrates \p window after the stream has come in packets, accumulated on the way.
  Closed accumulated(const ExposureInterval& expected, std::int64_t expected_reference_ns,
                     const ExposureInterval& window, std::int64_t reference_ns,
                     std::size_t packet = 1000) const {
    Lists lists(kPathSize, {});
    DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
    integral.predictWindow(expected, expected_reference_ns);
    for (WireEvents rest = wireView(wire_); !rest.empty();) {
      const std::size_t count = std::min(packet, rest.count);
      lists.append(WireEvents{rest.data, count});
      integral.accumulate(lists);
      rest = rest.from(count);
    }
    return closeWith(integral, lists, window, reference_ns);
  }

  Closed integratedFromLog(const ExposureInterval& window, std::int64_t reference_ns) const {
    Lists lists(kPathSize, {});
    lists.append(wireView(wire_));
    return integrated(lists, kUnequal, GetParam(), window, reference_ns);
  }

  std::vector<std::uint8_t> wire_;
};

constexpr SensorSize DoubleIntegralPaths::kPathSize;

INSTANTIATE_TEST_SUITE_P(Models, DoubleIntegralPaths, ::testing::ValuesIn(kModels), modelName);

TEST_P(DoubleIntegralPaths, AgreeWhenThePredictionIsExact) {
  for (const ExposureInstant instant :
       {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
    const std::int64_t reference_ns = kWindow.at(instant);
    const Closed expected = integratedFromLog(kWindow, reference_ns);
    EXPECT_EQ(expected.report.kind, IntegrationKind::kNotPredicted);
    EXPECT_EQ(expected.report.walked, expected.report.events);
    for (const std::size_t packet :
         {std::size_t{1}, std::size_t{7}, std::size_t{1000}, std::size_t{70'000}, kEvents}) {
      const Closed closed = accumulated(kWindow, reference_ns, kWindow, reference_ns, packet);
      EXPECT_EQ(closed.gain, expected.gain);
      EXPECT_EQ(closed.report.kind, IntegrationKind::kPredicted);
      EXPECT_EQ(closed.report.events, expected.report.events);
      EXPECT_LT(closed.report.walked, closed.report.events / 10);
    }
  }
}

TEST_P(DoubleIntegralPaths, AgreeWhenThePredictionIsOffByMicroseconds) {
  std::mt19937 random(8);
  int predicted_count = 0;
  constexpr int kTries = 60;
  for (int i = 0; i < kTries; ++i) {
    const auto offset = [&] {
      return (static_cast<std::int64_t>(random() % 99) - 49) * kMicrosecond;
    };
    const ExposureInterval expected{kWindow.start_ns + offset(), kWindow.end_ns + offset()};
    const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
    const Closed closed = accumulated(expected, reference_ns + offset(), kWindow, reference_ns);
    ASSERT_EQ(closed.gain, integratedFromLog(kWindow, reference_ns).gain)
        << "expected start off by " << expected.start_ns - kWindow.start_ns << " ns, end by "
        << expected.end_ns - kWindow.end_ns << " ns";
    predicted_count += closed.report.kind == IntegrationKind::kPredicted ? 1 : 0;
  }
  EXPECT_GT(predicted_count, kTries * 8 / 10);
}

TEST_P(DoubleIntegralPaths, AgreeWhereverTheWindowStarts) {
  // Steps that come by every place relative to the quantum of base instants.
  constexpr std::int64_t kQuantum = 1 << 19;
  int not_predicted = 0;
  int tries = 0;
  for (std::int64_t step_ns = 0; step_ns < kQuantum; step_ns += 9'973) {
    const ExposureInterval window{kWindow.start_ns + step_ns, kWindow.end_ns + step_ns};
    const std::int64_t reference_ns = window.at(ExposureInstant::kMid);
    const std::vector<float> expected = integratedFromLog(window, reference_ns).gain;
    for (const std::int64_t off_ns : {-30 * kMicrosecond, kMicrosecond}) {
      const Closed closed = accumulated({window.start_ns + off_ns, window.end_ns + off_ns},
                                        reference_ns + off_ns, window, reference_ns, 20'000);
      ASSERT_EQ(closed.gain, expected) << "step " << step_ns << " off " << off_ns;
      not_predicted += closed.report.kind == IntegrationKind::kNotPredicted ? 1 : 0;
      ++tries;
    }
  }
  // Straddling a quantum is rare, but must have come up for the comparison to mean something.
  EXPECT_GT(not_predicted, 0);
  EXPECT_LT(not_predicted, tries / 10);
}

TEST_P(DoubleIntegralPaths, AgreeWhenThePredictionIsWrong) {
  const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
  const std::vector<float> expected = integratedFromLog(kWindow, reference_ns).gain;
  for (const std::int64_t start_off : {-4, 0, 3, 40, 400}) {
    for (const std::int64_t end_off : {-6, 0, 4, 500}) {
      for (const std::int64_t reference_off : {-20, -3, 0, 8}) {
        const ExposureInterval guess{kWindow.start_ns + start_off * kMillisecond,
                                     kWindow.end_ns + end_off * kMillisecond};
        const Closed closed = accumulated(guess, reference_ns + reference_off * kMillisecond,
                                          kWindow, reference_ns, 5000);
        ASSERT_EQ(closed.gain, expected) << start_off << " " << end_off << " " << reference_off;
      }
    }
  }
}

TEST_P(DoubleIntegralPaths, AgreeForLatentImagesOfOneExposure) {
  // Several reference times for one window, after each other on the same integral.
  Lists lists(kPathSize, {});
  lists.append(wireView(wire_));
  DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
  integral.predictWindow(kWindow, kWindow.at(ExposureInstant::kMid));
  integral.accumulate(lists);
  for (int i = 0; i <= 10; ++i) {
    const std::int64_t reference_ns = kWindow.start_ns + kWindow.length() * i / 10;
    ASSERT_EQ(closeWith(integral, lists, kWindow, reference_ns).gain,
              integratedFromLog(kWindow, reference_ns).gain);
  }
}

TEST_P(DoubleIntegralPaths, AgreeAfterAFlush) {
  Lists lists(kPathSize, {});
  DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
  const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
  integral.predictWindow(kWindow, reference_ns);
  lists.append(WireEvents{wire_.data(), kEvents / 2});
  integral.accumulate(lists);

  lists.flush();
  integral.reset();
  integral.predictWindow(kWindow, reference_ns);
  lists.append(wireView(wire_));
  integral.accumulate(lists);
  const Closed closed = closeWith(integral, lists, kWindow, reference_ns);
  EXPECT_EQ(closed.report.kind, IntegrationKind::kPredicted);
  EXPECT_EQ(closed.gain, integratedFromLog(kWindow, reference_ns).gain);
}

TEST_P(DoubleIntegralPaths, BeginWithTheFirstEventAfterAFlush) {
  Lists lists(kPathSize, {});
  DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
  const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
  lists.append(wireView(wire_));
  lists.flush();
  integral.predictWindow(kWindow, reference_ns);
  integral.accumulate(lists);  // the newest event is of before
  lists.append(wireView(wire_));
  integral.accumulate(lists);
  const Closed closed = closeWith(integral, lists, kWindow, reference_ns);
  EXPECT_EQ(closed.report.kind, IntegrationKind::kPredicted);
  EXPECT_EQ(closed.gain, integratedFromLog(kWindow, reference_ns).gain);
}

TEST_P(DoubleIntegralPaths, AgreeAfterAnOverflow) {
  // Full long before the window ends: what is left is what counts, however it was accumulated.
  PixelEventLists::Limits limits;
  limits.max_events = 80'000;
  Lists lists(kPathSize, limits);
  DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
  const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
  integral.predictWindow(kWindow, reference_ns);
  for (WireEvents rest = wireView(wire_); !rest.empty();) {
    const std::size_t count = std::min<std::size_t>(1500, rest.count);
    lists.append(WireEvents{rest.data, count});
    integral.accumulate(lists);
    rest = rest.from(count);
  }
  ASSERT_GT(lists.overflowed(), 0u);
  ASSERT_GT(lists.completeFrom(), kWindow.start_ns);
  EXPECT_EQ(closeWith(integral, lists, kWindow, reference_ns).gain,
            integrated(lists, kUnequal, GetParam(), kWindow, reference_ns).gain);
}

TEST_P(DoubleIntegralPaths, AgreeAfterOverflowBetweenFollows) {
  PixelEventLists::Limits limits;
  limits.max_events = 80'000;
  Lists lists(kPathSize, limits);
  DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
  const std::int64_t reference_ns = kWindow.at(ExposureInstant::kMid);
  integral.predictWindow(kWindow, reference_ns);
  const WireEvents all = wireView(wire_);
  lists.append(WireEvents{all.data, 40'000});
  integral.accumulate(lists);
  lists.append(all.from(40'000));
  integral.accumulate(lists);
  EXPECT_EQ(closeWith(integral, lists, kWindow, reference_ns).gain,
            integrated(lists, kUnequal, GetParam(), kWindow, reference_ns).gain);
}

TEST_P(DoubleIntegralPaths, AgreeOverARunOfFrames) {
  // Periodic frames with jitter, events beyond the window already there when it is closed, what is
  // not needed any more dropped: as the pipeline does it.
  constexpr std::int64_t kPeriod = 5 * kMillisecond;
  constexpr std::int64_t kExposure = 3 * kMillisecond;
  std::mt19937 random(9);
  Lists all(kPathSize, {});
  all.append(wireView(wire_));
  Lists lists(kPathSize, {});
  DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
  WireEvents rest = wireView(wire_);
  int predicted_count = 0;
  ExposureInterval last{};
  for (std::int64_t at_ns = kStart + kMillisecond; at_ns < kStart + 34 * kMillisecond;
       at_ns += kPeriod) {
    const std::int64_t jitter_ns = static_cast<std::int64_t>(random() % 20) * kMicrosecond;
    const ExposureInterval window{at_ns + jitter_ns, at_ns + jitter_ns + kExposure};
    while (!rest.empty() && (!lists.hasNewest() || lists.newest() < window.end_ns)) {
      const std::size_t count = std::min<std::size_t>(777, rest.count);
      lists.append(WireEvents{rest.data, count});
      integral.accumulate(lists);
      rest = rest.from(count);
    }
    const std::int64_t reference_ns = window.at(ExposureInstant::kMid);
    const Closed closed = closeWith(integral, lists, window, reference_ns);
    ASSERT_EQ(closed.gain, integrated(all, kUnequal, GetParam(), window, reference_ns).gain);
    predicted_count += closed.report.kind == IntegrationKind::kPredicted ? 1 : 0;
    last = window;
    const ExposureInterval next{last.start_ns + kPeriod, last.end_ns + kPeriod};
    integral.predictWindow(next, next.at(ExposureInstant::kMid));
    lists.discardBefore(last.end_ns);
  }
  EXPECT_GE(predicted_count, 4);
}

TEST_P(DoubleIntegralPaths, AgreeUnderRandomSchedules) {
  const SensorSize size{16, 12};
  constexpr int kSchedules = 150;
  constexpr int kSteps = 60;
  constexpr std::int64_t kSpan = 20 * kMillisecond;
  for (int seed = 0; seed < kSchedules; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    const auto below = [&](std::int64_t bound) {
      return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(bound));
    };
    const std::vector<Event> events = makeEvents(
        EventScene::kUniform, {size, 4000, kStart, kSpan, static_cast<std::uint64_t>(seed)});
    const std::vector<std::uint8_t> wire = toWire(events);
    const auto randomWindow = [&] {
      const std::int64_t start_ns = kStart + below(kSpan);
      return ExposureInterval{start_ns, start_ns + 1 + below(kSpan / 2)};
    };
    Lists lists(size, {});
    DoubleIntegral integral(size, kUnequal, GetParam().weighting, GetParam().level);
    WireEvents rest = wireView(wire);
    ExposureInterval expected = randomWindow();
    for (int step = 0; step < kSteps; ++step) {
      switch (below(5)) {
        case 0: {
          const std::size_t count = std::min<std::size_t>(below(400), rest.count);
          lists.append(WireEvents{rest.data, count});
          rest = rest.from(count);
          break;
        }
        case 1:
          expected = randomWindow();
          integral.predictWindow(expected, expected.start_ns + below(expected.length() + 1));
          break;
        case 2:
          integral.accumulate(lists);
          break;
        case 3:
          if (below(10) == 0) integral.reset();
          break;
        default: {
          const bool as_expected = below(2) == 0;
          const ExposureInterval window = as_expected ? expected : randomWindow();
          const std::int64_t reference_ns = window.start_ns + below(window.length() + 1);
          const Closed closed = closeWith(integral, lists, window, reference_ns);
          ASSERT_EQ(closed.gain,
                    integrated(lists, kUnequal, GetParam(), window, reference_ns).gain);
          const std::vector<Event> so_far(
              events.begin(),
              events.begin() + static_cast<std::ptrdiff_t>(events.size() - rest.count));
          expectReciprocals(closed.gain,
                            referenceOf(GetParam(), size, so_far, kUnequal, window, reference_ns));
          ASSERT_FALSE(::testing::Test::HasFatalFailure());
        }
      }
    }
  }
}

// Memory.

TEST(DoubleIntegral, NeedsAtMostFortyEightBytesForEachPixel) {
  constexpr std::size_t kMaxBytesPerPixel = 48;
  const SensorSize size{346, 260};
  const DoubleIntegral integral(size, kEqual, Weighting::kTime);
  EXPECT_LE(integral.memoryBytes(), kMaxBytesPerPixel * size.pixelCount());
  EXPECT_GT(integral.memoryBytes(), size.pixelCount());
}

TEST_P(DoubleIntegralPaths, AllocateNothing) {
  Lists lists(kPathSize, {});
  lists.append(wireView(wire_));
  DoubleIntegral integral(kPathSize, kUnequal, GetParam().weighting, GetParam().level);
  std::vector<float> gain(kPathSize.pixelCount());
  const std::uint64_t before = allocationCount();
  ASSERT_GT(before, 0u);
  for (int i = 0; i < 4; ++i) {
    integral.predictWindow(kWindow, kWindow.start_ns);
    integral.accumulate(lists);
    integral.integrate(lists, kWindow, kWindow.start_ns, gain.data());
    integral.integrate(lists, kWindow, kWindow.end_ns, gain.data());
    integral.reset();
  }
  EXPECT_EQ(allocationCount(), before);
}

}  // namespace
}  // namespace fast_edi
