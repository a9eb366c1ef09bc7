#include "fast_edi/events/pixel_event_lists.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/event_generators.hpp"
#include "support/paper_lists.hpp"
#include "support/reference_double_integral.hpp"

namespace fast_edi {

static bool operator==(const Event& a, const Event& b) {
  return a.x == b.x && a.y == b.y && a.t_ns == b.t_ns && a.on == b.on;
}

namespace {

using testing::allocationCount;
using testing::EventScene;
using testing::EventSpec;
using ::testing::HasSubstr;
using testing::makeEvents;
using testing::toWire;
using testing::wireView;

constexpr SensorSize kSize{346, 260};
constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kMillisecond = kNanosecondsPerMillisecond;
constexpr std::int64_t kStart = 1'600'000'000 * kSecond;

std::vector<Event> uniformEvents(std::size_t count, std::int64_t start_ns,
                                 std::int64_t duration_ns) {
  return makeEvents(EventScene::kUniform, {kSize, count, start_ns, duration_ns, 5});
}

AppendResult append(PixelEventLists& lists, const std::vector<Event>& events) {
  const std::vector<std::uint8_t> wire = toWire(events);
  return lists.append(wireView(wire));
}

/// Everything that is buffered, oldest first.
std::vector<Event> contents(const PixelEventLists& lists) {
  std::vector<Event> events;
  std::uint64_t sequence = lists.beginSequence();
  while (sequence < lists.endSequence()) {
    const PackedEventSpan span = lists.span(sequence, lists.endSequence());
    EXPECT_EQ(span.first_sequence, sequence);
    if (span.count == 0) {
      ADD_FAILURE() << "empty span inside the buffered range";
      break;
    }
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::uint32_t pixel = span.data[i].code / 2;
      const auto width = static_cast<std::uint32_t>(lists.size().width);
      events.push_back({static_cast<std::uint16_t>(pixel % width),
                        static_cast<std::uint16_t>(pixel / width),
                        span.base_ns + span.data[i].dt_ns, (span.data[i].code & 1u) != 0});
    }
    sequence += span.count;
  }
  return events;
}

TEST(PixelEventLists, HoldsWhatWasAppendedInOrder) {
  const std::vector<Event> events = uniformEvents(200'003, kStart, 40 * kMillisecond);
  PixelEventLists lists(kSize, {});
  const AppendResult result = append(lists, events);
  EXPECT_EQ(result.consumed, events.size());
  EXPECT_EQ(result.accepted, events.size());
  EXPECT_EQ(result.stop, AppendStop::kNone);
  EXPECT_EQ(lists.eventCount(), events.size());
  EXPECT_EQ(lists.newest(), events.back().t_ns);
  EXPECT_EQ(contents(lists), events);
}

TEST(PixelEventLists, DoesNotDependOnPacketBorders) {
  // Over a change of the second, which wire records carry in a field of its own.
  const std::vector<Event> events =
      uniformEvents(150'000, kStart + kSecond - 20 * kMillisecond, 40 * kMillisecond);
  const std::vector<std::uint8_t> wire = toWire(events);
  std::mt19937 random(1);
  for (const std::size_t longest :
       {std::size_t{1}, std::size_t{3}, std::size_t{200}, std::size_t{50'000}}) {
    PixelEventLists lists(kSize, {});
    WireEvents rest = wireView(wire);
    while (!rest.empty()) {
      // A copy without slack: reading past an array's end must show under the sanitizers.
      const std::size_t count = std::min<std::size_t>(1 + random() % longest, rest.count);
      const std::vector<std::uint8_t> packet(rest.data, rest.data + count * kWireEventBytes);
      EXPECT_EQ(lists.append(wireView(packet)).accepted, count);
      rest = rest.from(count);
    }
    EXPECT_EQ(contents(lists), events) << "packets of up to " << longest;
  }
}

TEST(PixelEventLists, TakesSingleEventsLikePackets) {
  const std::vector<Event> events = uniformEvents(1000, kStart, 40 * kMillisecond);
  PixelEventLists lists(kSize, {});
  for (const Event& event : events) EXPECT_EQ(lists.append(event).accepted, 1u);
  EXPECT_EQ(contents(lists), events);
}

TEST(PixelEventLists, TakesAnyNonZeroPolarityByteAsOn) {
  const std::vector<Event> events(64, Event{3, 4, kStart, true});
  std::vector<std::uint8_t> wire = toWire(events);
  for (std::size_t i = 0; i < events.size(); ++i) {
    wire[i * kWireEventBytes + kWireEventBytes - 1] = static_cast<std::uint8_t>(1 + 4 * i);
  }
  PixelEventLists lists(kSize, {});
  lists.append(wireView(wire));
  EXPECT_EQ(contents(lists), events);
}

TEST(PixelEventLists, CoversHoursOfSparseEvents) {
  PixelEventLists lists(kSize, {});
  std::vector<Event> events;
  for (int i = 0; i < 100; ++i) events.push_back({1, 2, kStart + i * 9 * kSecond, i % 2 == 0});
  EXPECT_EQ(append(lists, events).accepted, events.size());
  EXPECT_EQ(contents(lists), events);
}

TEST(PixelEventLists, AcceptsTheSensorsCornersOnly) {
  PixelEventLists lists(kSize, {});
  std::vector<Event> events;
  for (const std::uint16_t x : {0, 345, 346, 32767, 32768, 65535}) {
    for (const std::uint16_t y : {0, 259, 260, 32767, 32768, 65535}) {
      events.push_back({x, y, kStart, true});
    }
  }
  for (int repeat = 0; repeat < 3; ++repeat)
    events.insert(events.end(), events.begin(), events.end());
  std::vector<Event> inside;
  std::copy_if(events.begin(), events.end(), std::back_inserter(inside),
               [](const Event& event) { return event.x < 346 && event.y < 260; });

  const AppendResult result = append(lists, events);
  EXPECT_EQ(result.consumed, events.size());
  EXPECT_EQ(result.accepted, inside.size());
  EXPECT_EQ(result.outside, events.size() - inside.size());
  EXPECT_EQ(contents(lists), inside);
}

TEST(PixelEventLists, CountsAndDropsLateEvents) {
  std::vector<Event> events = uniformEvents(1000, kStart, 40 * kMillisecond);
  const std::vector<Event> in_order = events;
  events.insert(events.begin() + 500, Event{1, 1, events[499].t_ns - 1, true});
  events.insert(events.begin() + 800, Event{1, 1, events[799].t_ns - 500 * kMillisecond, true});
  PixelEventLists lists(kSize, {});
  const AppendResult result = append(lists, events);
  EXPECT_EQ(result.consumed, events.size());
  EXPECT_EQ(result.accepted, in_order.size());
  EXPECT_EQ(result.late, 2u);
  EXPECT_EQ(contents(lists), in_order);
}

struct Jump {
  std::int64_t by_ns;
  AppendStop stop;
};

class PixelEventListsJump : public ::testing::TestWithParam<Jump> {};

TEST_P(PixelEventListsJump, StopsBeforeIt) {
  for (const std::size_t jump_at : {std::size_t{1}, std::size_t{2}, std::size_t{515}}) {
    std::vector<Event> events = uniformEvents(1000, kStart, 40 * kMillisecond);
    for (std::size_t i = jump_at; i < events.size(); ++i) {
      events[i].t_ns = events[jump_at - 1].t_ns + GetParam().by_ns;
    }
    PixelEventLists lists(kSize, {});
    const std::vector<std::uint8_t> wire = toWire(events);
    const AppendResult result = lists.append(wireView(wire));
    EXPECT_EQ(result.stop, GetParam().stop);
    EXPECT_EQ(result.consumed, jump_at);
    EXPECT_EQ(result.accepted, jump_at);
    EXPECT_EQ(lists.newest(), events[jump_at - 1].t_ns);
    EXPECT_EQ(lists.append(events[jump_at]).stop, GetParam().stop);

    lists.flush();
    const AppendResult rest = lists.append(wireView(wire).from(jump_at));
    EXPECT_EQ(rest.stop, AppendStop::kNone);
    EXPECT_EQ(rest.accepted, events.size() - jump_at);
    EXPECT_EQ(
        contents(lists),
        std::vector<Event>(events.begin() + static_cast<std::ptrdiff_t>(jump_at), events.end()));
  }
}

INSTANTIATE_TEST_SUITE_P(
    BothWays, PixelEventListsJump,
    ::testing::Values(Jump{-500 * kMillisecond - 1, AppendStop::kBackwardJump},
                      Jump{-3600 * kSecond, AppendStop::kBackwardJump},
                      Jump{-1'599'999'999 * kSecond, AppendStop::kBackwardJump},
                      Jump{10 * kSecond + 1, AppendStop::kForwardJump},
                      Jump{2'000'000'000 * kSecond, AppendStop::kForwardJump}));

TEST(PixelEventLists, GoesOnAfterASkippedForwardJump) {
  PixelEventLists lists(kSize, {});
  const std::vector<Event> before = uniformEvents(1000, kStart, 40 * kMillisecond);
  append(lists, before);
  EXPECT_EQ(lists.append(Event{0, 0, kStart + 3600 * kSecond, true}).stop,
            AppendStop::kForwardJump);
  EXPECT_EQ(append(lists, uniformEvents(1000, kStart + 40 * kMillisecond, kMillisecond)).accepted,
            1000u);
  EXPECT_EQ(lists.eventCount(), 2000u);
}

TEST(PixelEventLists, TakesStepsUpToTheJumpLimits) {
  PixelEventLists lists(kSize, {});
  lists.append(Event{0, 0, kStart, true});
  EXPECT_EQ(lists.append(Event{0, 0, kStart + 10 * kSecond, true}).accepted, 1u);
  EXPECT_EQ(lists.append(Event{0, 0, kStart + 10 * kSecond - 500 * kMillisecond, true}).late, 1u);
}

/// Appends all records, skipping those that jump. \return records read
std::size_t readsOfAll(PixelEventLists& lists, const std::vector<Event>& events) {
  const std::vector<std::uint8_t> wire = toWire(events);
  WireEvents rest = wireView(wire);
  std::size_t read = 0;
  while (!rest.empty()) {
    const AppendResult result = lists.append(rest);
    read += result.read;
    rest = rest.from(result.consumed + (result.stop == AppendStop::kNone ? 0 : 1));
  }
  return read;
}

/// Blocks of regular records are tried. One that turns out not to be regular was read in vain.
TEST(PixelEventLists, ReadsNextToNothingTwiceWhereNoBlockIsRegular) {
  constexpr std::size_t kCount = 10'000;
  for (const std::int64_t back_ns : {kMillisecond, kSecond}) {  // late, and too late
    PixelEventLists lists(kSize, {});
    std::vector<Event> events = uniformEvents(kCount, kStart, 100 * kMillisecond);
    std::vector<Event> kept;
    for (std::size_t i = 0; i < kCount; ++i) {
      if (i % 2 == 0) {
        kept.push_back(events[i]);
      } else {
        events[i].t_ns -= back_ns;
      }
    }
    EXPECT_LE(readsOfAll(lists, events), kCount + kCount / 8) << back_ns;
    EXPECT_EQ(contents(lists), kept) << back_ns;
  }
}

TEST(PixelEventLists, ReadsWholeBlocksAgainSoonAfterAnIrregularRecord) {
  constexpr std::size_t kCount = 10'000;
  constexpr std::size_t kBetweenStrays = 1'000;
  constexpr std::size_t kMostInVain = 128;  ///< a block
  PixelEventLists lists(kSize, {});
  std::vector<Event> events = uniformEvents(kCount, kStart, 100 * kMillisecond);
  for (std::size_t i = kBetweenStrays; i < kCount; i += kBetweenStrays) {
    events[i].t_ns += 20 * kSecond;
  }
  const std::size_t strays = kCount / kBetweenStrays - 1;
  EXPECT_LE(readsOfAll(lists, events), kCount + strays * kMostInVain);
  EXPECT_EQ(lists.eventCount(), kCount - strays);
}

TEST(PixelEventLists, FindsTheFirstEventNotBeforeATime) {
  const std::vector<Event> events = uniformEvents(150'000, kStart, 40 * kMillisecond);
  PixelEventLists lists(kSize, {});
  EXPECT_EQ(lists.lowerBound(kStart), lists.endSequence());
  append(lists, events);
  const auto expected = [&](std::int64_t t_ns) {
    const auto found =
        std::lower_bound(events.begin(), events.end(), t_ns,
                         [](const Event& event, std::int64_t t) { return event.t_ns < t; });
    return static_cast<std::uint64_t>(found - events.begin());
  };
  for (std::int64_t t_ns = kStart - 2000; t_ns < kStart + 41 * kMillisecond; t_ns += 33'333) {
    ASSERT_EQ(lists.lowerBound(t_ns), expected(t_ns));
    ASSERT_EQ(lists.lowerBound(events[expected(t_ns) % events.size()].t_ns),
              expected(events[expected(t_ns) % events.size()].t_ns));
  }
}

TEST(PixelEventLists, SpansStayWithinTheRangeAskedFor) {
  PixelEventLists lists(kSize, {});
  append(lists, uniformEvents(150'000, kStart, 40 * kMillisecond));
  EXPECT_EQ(lists.span(10, 10).count, 0u);
  EXPECT_EQ(lists.span(150'000, 200'000).count, 0u);
  EXPECT_EQ(lists.span(10, 25).count, 15u);
  EXPECT_EQ(lists.span(149'990, 999'999).count, 10u);
}

TEST(PixelEventLists, DropsWhatNoComingFrameCanAskFor) {
  const std::vector<Event> events = uniformEvents(400'000, kStart, 40 * kMillisecond);
  PixelEventLists lists(kSize, {});
  append(lists, events);
  EXPECT_EQ(lists.completeFrom(), INT64_MIN);

  const std::int64_t keep_ns = kStart + 20 * kMillisecond;
  const std::uint64_t first_kept = lists.lowerBound(keep_ns);
  lists.discardBefore(keep_ns);
  EXPECT_LE(lists.completeFrom(), keep_ns);
  EXPECT_EQ(lists.lowerBound(keep_ns), first_kept);
  EXPECT_LT(first_kept - lists.beginSequence(), PixelEventLists::kChunkEvents);
  EXPECT_GT(lists.beginSequence(), 0u);
  EXPECT_EQ(contents(lists),
            std::vector<Event>(events.begin() + static_cast<std::ptrdiff_t>(lists.beginSequence()),
                               events.end()));
  EXPECT_EQ(lists.overflowed(), 0u);

  lists.discardBefore(kStart + kSecond);
  EXPECT_TRUE(lists.empty());
  EXPECT_TRUE(lists.hasNewest());
  EXPECT_EQ(lists.newest(), events.back().t_ns);
  EXPECT_EQ(lists.endSequence(), events.size());
}

TEST(PixelEventLists, KeepsTheNewestEventsWhenFull) {
  constexpr std::size_t kMaxEvents = 300'000;
  PixelEventLists::Limits limits;
  limits.max_events = kMaxEvents;
  PixelEventLists lists(kSize, limits);
  const std::vector<Event> events = uniformEvents(1'000'000, kStart, 40 * kMillisecond);
  const std::vector<std::uint8_t> wire = toWire(events);
  constexpr std::size_t kPacket = 1234;
  for (WireEvents rest = wireView(wire); !rest.empty();) {
    const std::size_t count = std::min(kPacket, rest.count);
    EXPECT_EQ(lists.append(WireEvents{rest.data, count}).accepted, count);
    rest = rest.from(count);
    ASSERT_LE(lists.eventCount(), kMaxEvents);
  }
  EXPECT_GT(lists.eventCount(), kMaxEvents - 2 * PixelEventLists::kChunkEvents);
  EXPECT_EQ(lists.overflowed() + lists.eventCount(), events.size());
  EXPECT_EQ(lists.beginSequence(), lists.overflowed());
  EXPECT_EQ(lists.completeFrom(), events[lists.beginSequence() - 1].t_ns + 1);
  EXPECT_EQ(contents(lists),
            std::vector<Event>(events.begin() + static_cast<std::ptrdiff_t>(lists.beginSequence()),
                               events.end()));
}

TEST(PixelEventLists, WorksWithTheSmallestLimits) {
  PixelEventLists::Limits limits;
  limits.max_events = 1;
  PixelEventLists lists(kSize, limits);
  const std::vector<Event> events = uniformEvents(1000, kStart, 40 * kMillisecond);
  append(lists, events);
  EXPECT_EQ(contents(lists), std::vector<Event>{events.back()});
  EXPECT_EQ(lists.overflowed(), 999u);
}

TEST(PixelEventLists, TakesJumpLimitsOfANanosecond) {
  PixelEventLists lists(kSize, {10, 1, 1});
  const auto at = [](std::int64_t t_ns) { return Event{1, 2, kStart + t_ns, true}; };
  EXPECT_EQ(lists.append(at(0)).accepted, 1u);
  EXPECT_EQ(lists.append(at(1)).accepted, 1u);
  EXPECT_EQ(lists.append(at(3)).stop, AppendStop::kForwardJump);
  EXPECT_EQ(lists.append(at(0)).late, 1u);
  EXPECT_EQ(lists.append(at(-1)).stop, AppendStop::kBackwardJump);
}

TEST(PixelEventLists, StartsAnewAfterAFlush) {
  PixelEventLists lists(kSize, {});
  append(lists, uniformEvents(100'000, kStart, 40 * kMillisecond));
  lists.discardBefore(kStart + 30 * kMillisecond);
  const std::uint64_t end_before = lists.endSequence();
  lists.flush();
  EXPECT_TRUE(lists.empty());
  EXPECT_FALSE(lists.hasNewest());
  EXPECT_EQ(lists.beginSequence(), end_before);
  EXPECT_EQ(lists.lowerBound(0), end_before);

  const std::vector<Event> earlier = uniformEvents(1000, 5 * kSecond, 40 * kMillisecond);
  EXPECT_EQ(append(lists, earlier).accepted, earlier.size());
  EXPECT_EQ(contents(lists), earlier);
  EXPECT_EQ(lists.endSequence(), end_before + earlier.size());
}

TEST(PixelEventLists, ChangesItsSensor) {
  PixelEventLists lists(kSize, {});
  append(lists, uniformEvents(1000, kStart, 40 * kMillisecond));
  lists.reset({1280, 720}, {});
  EXPECT_TRUE(lists.empty());
  EXPECT_EQ(lists.append(Event{1279, 719, kStart, true}).accepted, 1u);
  EXPECT_EQ(lists.append(Event{1280, 0, kStart, true}).outside, 1u);
  lists.reset({16, 16}, {});
  EXPECT_EQ(lists.append(Event{16, 0, kStart, true}).outside, 1u);
}

TEST(PixelEventLists, WorksOnTheLargestSensor) {
  const SensorSize size{32767, 32767};
  PixelEventLists lists(size, {});
  std::vector<Event> events;
  for (int i = 0; i < 40; ++i) {
    events.push_back({static_cast<std::uint16_t>(32766 - i), 32766, kStart + i, i % 3 == 0});
  }
  EXPECT_EQ(append(lists, events).accepted, events.size());
  EXPECT_EQ(contents(lists), events);
}

TEST(PixelEventLists, RefusesBadSizesAndLimits) {
  for (const SensorSize size : {SensorSize{0, 260}, SensorSize{346, 0}, SensorSize{-1, 260},
                                SensorSize{32768, 1}, SensorSize{1, 32768}}) {
    EXPECT_THROW(PixelEventLists(size, {}), std::invalid_argument);
  }
  EXPECT_THROW(PixelEventLists(kSize, {0, 1, 1}), std::invalid_argument);
  EXPECT_THROW(PixelEventLists(kSize, {1, 0, 1}), std::invalid_argument);
  EXPECT_THROW(PixelEventLists(kSize, {1, 1, 0}), std::invalid_argument);
  try {
    PixelEventLists lists({346, 40'000}, {});
    FAIL() << "40000 rows were accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("40000"));
  }
}

// One pixel's list as the paper writes it.

TEST(PixelEventLists, ListsOnePixelAsExpValueAndCounter) {
  const ContrastThresholds thresholds{0.3, 0.2};
  PixelEventLists lists(kSize, {});
  append(lists, {{5, 5, kStart, true},       // before the window
                 {5, 5, kStart + 10, true},  // at its start
                 {6, 5, kStart + 11, true},
                 {5, 5, kStart + 12, false},
                 {5, 6, kStart + 12, false},
                 {5, 5, kStart + 19, false},
                 {5, 5, kStart + 20, true}});  // at its end
  const std::vector<ListEntry> list = lists.list(5, 5, {kStart + 10, kStart + 20}, thresholds);
  ASSERT_EQ(list.size(), 3u);
  const double exp_values[] = {std::exp(0.3), std::exp(0.1), std::exp(-0.1)};
  const std::int64_t counters[] = {0, 2, 4};
  const std::int64_t times[] = {kStart + 10, kStart + 12, kStart + 19};
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_NEAR(list[i].exp_value, exp_values[i], 1e-12);
    EXPECT_EQ(list[i].counter, counters[i]);
    EXPECT_EQ(list[i].t_ns, times[i]);
  }
}

TEST(PixelEventLists, ListsAreThoseOfThePaper) {
  // A small sensor, so that lists are long; the paper's lists start with the first event.
  const SensorSize size{12, 9};
  const ContrastThresholds thresholds{0.25, 0.25};
  const std::vector<Event> events =
      makeEvents(EventScene::kUniform, {size, 100'000, kStart, 40 * kMillisecond, 8});
  PixelEventLists lists(size, {});
  append(lists, events);
  testing::PaperLists paper(size, thresholds, Weighting::kCounter);
  for (const Event& event : events) paper.add(event);

  const ExposureInterval all{kStart, kStart + 40 * kMillisecond};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::vector<ListEntry> list = lists.list(x, y, all, thresholds);
      const auto& expected = paper.list(x, y);
      ASSERT_EQ(list.size(), expected.size());
      for (std::size_t i = 0; i < list.size(); ++i) {
        ASSERT_NEAR(list[i].exp_value / expected[i].exp_value, 1.0, 1e-9);
        ASSERT_EQ(list[i].counter, static_cast<std::int64_t>(expected[i].counter));
        ASSERT_EQ(list[i].t_ns, events[0].t_ns + static_cast<std::int64_t>(expected[i].t));
      }
    }
  }
}

TEST(PixelEventLists, ListsSumUpToTheDoubleIntegral) {
  const SensorSize size{12, 9};
  const ContrastThresholds thresholds{0.25, 0.25};
  const std::vector<Event> events =
      makeEvents(EventScene::kUniform, {size, 20'000, kStart, 40 * kMillisecond, 9});
  PixelEventLists lists(size, {});
  append(lists, events);
  const ExposureInterval window{kStart + 3 * kMillisecond, kStart + 33 * kMillisecond};
  const auto count =
      static_cast<double>(lists.lowerBound(window.end_ns) - lists.lowerBound(window.start_ns));
  const std::vector<double> expected = testing::referenceDoubleIntegral(
      size, events, thresholds, Weighting::kCounter, window, window.start_ns);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double sum = 0.0;
      ListEntry last;
      for (const ListEntry& entry : lists.list(x, y, window, thresholds)) {
        sum += last.exp_value * static_cast<double>(entry.counter - last.counter);
        last = entry;
      }
      sum += last.exp_value * (count - static_cast<double>(last.counter));
      ASSERT_NEAR(sum / count / expected[static_cast<std::size_t>(y * size.width + x)], 1.0, 1e-9);
    }
  }
}

// Memory.

TEST(PixelEventLists, NeedsAtMostTwelveBytesForEachEvent) {
  constexpr double kMaxBytesPerEvent = 12.0;
  for (const std::size_t count : {std::size_t{500'000}, std::size_t{2'000'000}}) {
    PixelEventLists lists(kSize, {});
    append(lists, uniformEvents(count, kStart, 40 * kMillisecond));
    EXPECT_LE(static_cast<double>(lists.memoryBytes()),
              kMaxBytesPerEvent * static_cast<double>(count));
    EXPECT_GE(lists.memoryBytes(), count * sizeof(PackedEvent));
  }
}

TEST(PixelEventLists, StaysWithinItsBoundForEver) {
  constexpr std::size_t kMaxEvents = 500'000;
  constexpr std::size_t kBytesPerEvent = 12;
  PixelEventLists::Limits limits;
  limits.max_events = kMaxEvents;
  PixelEventLists lists(kSize, limits);
  const std::vector<std::uint8_t> wire =
      toWire(uniformEvents(1'500'000, kStart, 40 * kMillisecond));
  for (int repeat = 0; repeat < 3; ++repeat) {
    lists.append(wireView(wire));
    EXPECT_LE(lists.memoryBytes(), kMaxEvents * kBytesPerEvent);
    lists.flush();
  }
}

TEST(PixelEventLists, GivesBackWhatABurstTookAndKeepsASpare) {
  constexpr std::size_t kBurst = 3'000'000;
  constexpr std::size_t kQuiet = 1000;
  constexpr std::size_t kSpareBytes = 4 << 20;
  constexpr int kFrames = 100;
  PixelEventLists lists(kSize, {});
  append(lists, uniformEvents(kBurst, kStart, 40 * kMillisecond));
  const std::size_t most = lists.memoryBytes();
  ASSERT_GT(most, kBurst * sizeof(PackedEvent));
  std::int64_t t_ns = kStart + 40 * kMillisecond;
  std::size_t before = most;
  for (int frame = 0; frame < kFrames; ++frame) {
    append(lists, uniformEvents(kQuiet, t_ns, 40 * kMillisecond));
    lists.discardBefore(t_ns);
    t_ns += 40 * kMillisecond;
    EXPECT_LE(lists.memoryBytes(), before) << frame;
    EXPECT_GE(lists.memoryBytes(), before - before / 8 - kSpareBytes / 4) << "not all at once";
    before = lists.memoryBytes();
  }
  EXPECT_LE(before, kSpareBytes);

  append(lists, uniformEvents(kBurst, t_ns, 40 * kMillisecond));
  lists.flush();
  EXPECT_LE(lists.memoryBytes(), kSpareBytes);
  EXPECT_GE(lists.memoryBytes(), 4 * PixelEventLists::kChunkEvents * sizeof(PackedEvent));
}

TEST(PixelEventLists, AllocatesNothingInSteadyState) {
  constexpr std::size_t kPacketsPerFrame = 40;
  constexpr std::int64_t kPacketDuration = kMillisecond;
  constexpr std::size_t kEventsPerPacket = 2048;
  // Frames end at different places within chunks; these repeat after four frames.
  static_assert(4 * kPacketsPerFrame * kEventsPerPacket % PixelEventLists::kChunkEvents == 0,
                "the least favourable place has to come up while warming up");
  constexpr int kWarmUpFrames = 8;
  constexpr int kFrames = 24;
  std::vector<std::vector<std::uint8_t>> packets;
  for (std::size_t i = 0; i < kPacketsPerFrame * kFrames; ++i) {
    packets.push_back(toWire(uniformEvents(kEventsPerPacket,
                                           kStart + static_cast<std::int64_t>(i) * kPacketDuration,
                                           kPacketDuration)));
  }
  PixelEventLists lists(kSize, {});
  std::uint64_t allocations_before = 0;
  std::size_t bytes_before = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (frame == kWarmUpFrames) {
      allocations_before = allocationCount();
      bytes_before = lists.memoryBytes();
      ASSERT_GT(allocations_before, 0u);
    }
    for (std::size_t i = 0; i < kPacketsPerFrame; ++i) {
      lists.append(wireView(packets[static_cast<std::size_t>(frame) * kPacketsPerFrame + i]));
    }
    lists.discardBefore(lists.newest() - 40 * kMillisecond);
  }
  EXPECT_EQ(allocationCount(), allocations_before);
  EXPECT_EQ(lists.memoryBytes(), bytes_before);
}

TEST(PixelEventLists, OthersHoldTheEventsOfAWindow) {
  PixelEventLists lists(kSize, {});
  append(lists, uniformEvents(300'000, kStart, kSecond));
  const ExposureInterval window{kStart + 400 * kMillisecond, kStart + 500 * kMillisecond};
  const PixelEventLists others(lists, window);
  EXPECT_EQ(others.size(), lists.size());
  EXPECT_EQ(others.newest(), lists.newest());
  EXPECT_LT(others.eventCount(), lists.eventCount());
  const std::uint64_t begin = lists.lowerBound(window.start_ns);
  const std::uint64_t end = lists.lowerBound(window.end_ns);
  ASSERT_EQ(others.lowerBound(window.start_ns), begin);
  ASSERT_EQ(others.lowerBound(window.end_ns), end);
  lists.discardBefore(kStart + kSecond);
  append(lists, uniformEvents(300'000, kStart + kSecond, kSecond));
  std::uint64_t events = 0;
  for (std::uint64_t next = begin; next < end;) {
    const PackedEventSpan span = others.span(next, end);
    ASSERT_GT(span.count, 0u);
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::int64_t t_ns = span.base_ns + static_cast<std::int64_t>(span.data[i].dt_ns);
      ASSERT_GE(t_ns, window.start_ns);
      ASSERT_LT(t_ns, window.end_ns);
    }
    events += span.count;
    next += span.count;
  }
  EXPECT_EQ(events, end - begin);
}

}  // namespace
}  // namespace fast_edi
