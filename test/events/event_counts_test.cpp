#include "fast_edi/events/event_counts.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

using testing::EventScene;
using testing::makeEvents;

constexpr SensorSize kSize{40, 30};
constexpr std::int64_t kStart = 1'600'000'000 * kNanosecondsPerSecond;
constexpr std::int64_t kMillisecond = kNanosecondsPerMillisecond;

std::vector<std::uint16_t> slowCounts(const std::vector<Event>& events,
                                      const ExposureInterval& window) {
  std::vector<std::uint16_t> counts(2 * kSize.pixelCount());
  for (const Event& event : events) {
    if (event.t_ns >= window.start_ns && event.t_ns < window.end_ns) {
      ++counts[2 * static_cast<std::size_t>(event.y * kSize.width + event.x) + (event.on ? 1 : 0)];
    }
  }
  return counts;
}

std::vector<std::uint16_t> countsOf(const EventCounts& counts) {
  return {counts.data(), counts.data() + 2 * counts.pixelCount()};
}

TEST(EventCounts, CountTheEventsOfAnyWindowHoweverItWasFollowed) {
  const std::vector<Event> events =
      makeEvents(EventScene::kUniform, {kSize, 300'000, kStart, 200 * kMillisecond, 7});
  PixelEventLists lists(kSize, {});
  EventCounts counts(kSize);
  std::mt19937 random(5);
  const auto windowUpTo = [&random](std::int64_t end_ns) {
    const std::int64_t length = static_cast<std::int64_t>(random() % 60) * kMillisecond;
    return ExposureInterval{end_ns - length, end_ns};
  };
  std::size_t next = 0;
  while (next < events.size()) {
    const std::size_t packet_end = std::min(events.size(), next + random() % 20'000);
    for (; next < packet_end; ++next) {
      lists.append(events[next]);
    }
    if (!lists.hasNewest()) {
      continue;
    }
    counts.accumulate(lists, windowUpTo(lists.newest() +
                                        static_cast<std::int64_t>(random() % 20) * kMillisecond));
    if (random() % 3 == 0) {
      const ExposureInterval window = windowUpTo(lists.newest());
      counts.count(lists, window);
      ASSERT_EQ(countsOf(counts), slowCounts(events, window));
    }
  }
}

TEST(EventCounts, AnEventAtTheEndIsOutsideOneAtTheStartInside) {
  PixelEventLists lists(kSize, {});
  lists.append(Event{1, 0, kStart, true});
  lists.append(Event{1, 0, kStart + 5, false});
  lists.append(Event{1, 0, kStart + 10, true});
  EventCounts counts(kSize);
  counts.count(lists, {kStart, kStart + 10});
  EXPECT_EQ(counts.on(1), 1);
  EXPECT_EQ(counts.off(1), 1);
  EXPECT_EQ(counts.on(0), 0);
}

TEST(EventCounts, EventsThatLeftTheLogDoNoHarm) {
  const std::vector<Event> events =
      makeEvents(EventScene::kUniform, {kSize, 400'000, kStart, 200 * kMillisecond, 8});
  PixelEventLists lists(kSize, {});
  EventCounts counts(kSize);
  for (std::size_t i = 0; i < events.size(); ++i) {
    lists.append(events[i]);
    if (i == events.size() / 4) {
      counts.accumulate(lists, {kStart, kStart + 200 * kMillisecond});
    }
  }
  lists.discardBefore(kStart + 150 * kMillisecond);
  ASSERT_GT(lists.beginSequence(), 0U);
  const ExposureInterval window{kStart + 160 * kMillisecond, kStart + 190 * kMillisecond};
  counts.count(lists, window);
  EXPECT_EQ(countsOf(counts), slowCounts(events, window));
}

TEST(EventCounts, StartAnewWhenTheListsWereFlushed) {
  PixelEventLists lists(kSize, {});
  lists.append(Event{2, 2, kStart, true});
  EventCounts counts(kSize);
  counts.accumulate(lists, {kStart, kStart + kMillisecond});
  lists.flush();
  counts.reset();
  lists.append(Event{3, 3, kStart, false});
  counts.count(lists, {kStart, kStart + kMillisecond});
  EXPECT_EQ(countsOf(counts),
            slowCounts({Event{3, 3, kStart, false}}, {kStart, kStart + kMillisecond}));
}

}  // namespace
}  // namespace fast_edi
