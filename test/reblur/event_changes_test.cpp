#include "reblur/event_changes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/events/event_counts.hpp"
#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{16, 12};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr ExposureInterval kWindow{10 * kMs, 30 * kMs};

/// The same from the gains at each instant: log(gain(t) / gain(mid)).
TEST(EventChangesTest, AreTheLogRatiosOfTheGains) {
  const std::vector<Event> list =
      testing::makeEvents(testing::EventScene::kUniform, {kSize, 3000, 0, 40 * kMs, 1});
  PixelEventLists lists(kSize, {});
  lists.keepIntervals(true);
  lists.append(testing::wireView(testing::toWire(list)));
  const LatentGains::Model model{{0.3, 0.25}, {4 * kMs, 0.85}};
  EventChanges changes;
  EventCounts counts(kSize);
  counts.count(lists, kWindow);
  LaterQuarters quarters(kSize);
  quarters.count(lists, kWindow);
  changes.measure(lists, kWindow, counts.data(), quarters, model);

  LatentGains gains;
  const std::vector<float> ones(kSize.pixelCount(), 1.0F);
  gains.start(ones.data(), lists, {20 * kMs, kWindow.end_ns}, model);
  std::vector<float> gain(kSize.pixelCount());
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    const auto t_ns =
        20 * kMs + static_cast<std::int64_t>(EventChanges::kTau[k] * static_cast<float>(10 * kMs));
    gains.at(lists, {t_ns, kWindow.end_ns}, gain.data());
    for (std::size_t i = 0; i < gain.size(); ++i) {
      ASSERT_NEAR(changes.at(k)[i], std::log(gain[i]), 1e-4F) << k << ", pixel " << i;
    }
    const std::size_t width = kSize.width;
    for (std::size_t i = 0; i < changes.halvedAt(k).size(); ++i) {
      const float* upper = changes.at(k).data() + i / (width / 2) * 2 * width + i % (width / 2) * 2;
      const float sum = upper[0] + upper[1] + upper[width] + upper[width + 1];
      ASSERT_NEAR(changes.halvedAt(k)[i], 0.25F * sum, 1e-4F) << k << ", pixel " << i;
    }
    EXPECT_EQ(changes.halvedAt(k).size(), kSize.pixelCount() / 4);
  }
}

TEST(EventChangesTest, OfManyEventsBegunStepsAreLeftOut) {
  const std::size_t count = 4 * EventChanges::kManyEvents * kSize.pixelCount();
  const std::vector<Event> list =
      testing::makeEvents(testing::EventScene::kUniform, {kSize, count, 0, 40 * kMs, 2});
  PixelEventLists lists(kSize, {});
  lists.keepIntervals(true);
  lists.append(testing::wireView(testing::toWire(list)));
  const LatentGains::Model model{{0.3, 0.25}, {4 * kMs, 0.85}};
  EventCounts counts(kSize);
  counts.count(lists, kWindow);
  EventChanges changes;
  LaterQuarters quarters(kSize);
  quarters.count(lists, kWindow);
  changes.measure(lists, kWindow, counts.data(), quarters, model);
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    const std::int64_t middle_ns = 20 * kMs;
    const auto t_ns =
        middle_ns + static_cast<std::int64_t>(EventChanges::kTau[k] * static_cast<float>(10 * kMs));
    std::vector<double> expected(kSize.pixelCount());
    for (const Event& event : list) {
      const bool between =
          event.t_ns >= std::min(t_ns, middle_ns) && event.t_ns < std::max(t_ns, middle_ns);
      const double step = between ? model.thresholds.step(event.on) : 0.0;
      expected[std::size_t{event.y} * kSize.width + event.x] += t_ns < middle_ns ? -step : step;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_NEAR(static_cast<double>(changes.at(k)[i]), expected[i], 1e-4) << k << ", pixel " << i;
    }
  }
}

/// With as many events as make begun steps matter little, to the event.
TEST(EventChangesTest, BegunStepsAreLeftOutFromSixteenEventsAPixelOn) {
  const LatentGains::Model model{{0.3, 0.25}, {4 * kMs, 0.85}};
  const std::size_t pixels = kSize.pixelCount();
  for (const std::size_t missing : {0U, 1U}) {
    std::vector<Event> list;
    for (std::size_t i = missing; i < 16 * pixels; ++i) {
      const auto from_start =
          static_cast<std::int64_t>(i) * kWindow.length() / static_cast<std::int64_t>(16 * pixels);
      list.push_back({static_cast<std::uint16_t>(i % kSize.width),
                      static_cast<std::uint16_t>(i / kSize.width % kSize.height),
                      kWindow.start_ns + from_start, true});
    }
    PixelEventLists lists(kSize, {});
    lists.keepIntervals(true);
    lists.append(testing::wireView(testing::toWire(list)));
    EventCounts counts(kSize);
    counts.count(lists, kWindow);
    LaterQuarters quarters(kSize);
    quarters.count(lists, kWindow);
    EventChanges changes;
    changes.measure(lists, kWindow, counts.data(), quarters, model);
    // Eight ON events until the end, and what has begun in the middle.
    const bool whole_steps = std::abs(changes.at(2)[7] - 8.0F * 0.3F) < 1e-4F;
    EXPECT_EQ(whole_steps, missing == 0);
  }
}

}  // namespace
}  // namespace fast_edi
