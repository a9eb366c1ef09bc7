#include "fast_edi/events/event_stream.hpp"

#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/array_kinds.hpp"
#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr SensorSize kSize{4, 3};
constexpr std::int64_t kBackLimit = 500 * kMs;
constexpr std::int64_t kForwardLimit = 10 * kSecond;
constexpr std::int64_t kStart = 1000 * kSecond;

class EventStreamTest : public ::testing::Test {
 protected:
  void take(const std::vector<std::int64_t>& times_ns, SensorSize size = kSize) {
    takeAs(++sequence, times_ns, size);
  }
  void takeAs(std::uint32_t number, const std::vector<std::int64_t>& times_ns,
              SensorSize size = kSize) {
    std::vector<Event> events;
    for (const std::int64_t t_ns : times_ns) {
      events.push_back({1, 1, t_ns, true});
    }
    const auto bytes = testing::toWire(events);
    sequence = number;
    stream.take(testing::wireView(bytes), size, number);
    checkThatNothingIsLost();
  }
  std::size_t buffered() const { return stream.lists()->eventCount(); }
  std::int64_t newest() const { return stream.lists()->newest(); }

  /// Every event that came is in the lists, was emptied out of them, is counted or is held apart.
  void checkThatNothingIsLost() const {
    const std::uint64_t accepted = stream.lists() ? stream.lists()->endSequence() : 0;
    const std::uint64_t gone = counters.events_late + counters.events_outside +
                               counters.events_glitched + counters.events_refused +
                               counters.events_repeated + dropped;
    EXPECT_LE(accepted + gone, counters.events_in);
    if (held == 0) {
      EXPECT_EQ(accepted + gone, counters.events_in);
    } else {
      EXPECT_EQ(accepted + gone + held, counters.events_in);
    }
  }

  DeblurCounters counters;
  std::vector<std::pair<StreamReset, std::int64_t>> breaks;
  std::size_t dropped = 0;  ///< on the way, before they came here
  std::size_t held = 0;     ///< events that the test expects to be held apart
  std::uint32_t sequence = 0;
  EventStream stream{
      PixelEventLists::Limits{1'000'000, kBackLimit, kForwardLimit}, counters,
      [this](StreamReset kind, std::int64_t next_ns) { breaks.emplace_back(kind, next_ns); }};
};

TEST_F(EventStreamTest, IsSeenFromTheFirstArrayOnEvenWhenItIsEmpty) {
  EXPECT_FALSE(stream.seen());
  EXPECT_FALSE(stream.covers({kStart, kStart + kMs}));
  take({});
  EXPECT_TRUE(stream.seen());
  EXPECT_FALSE(stream.covers({kStart, kStart + kMs}));
  EXPECT_FALSE(stream.hasReached(0));
}

TEST_F(EventStreamTest, CoversFromASlackBeforeTheFirstEvent) {
  take({kStart, kStart + kMs});
  EXPECT_TRUE(stream.covers({kStart - EventCoverage::kStartSlack_ns, kStart + kMs}));
  EXPECT_FALSE(stream.covers({kStart - EventCoverage::kStartSlack_ns - 1, kStart + kMs}));
}

TEST_F(EventStreamTest, ReachesTheTimeOfItsNewestEvent) {
  take({kStart, kStart + kMs});
  EXPECT_TRUE(stream.hasReached(kStart + kMs));
  EXPECT_FALSE(stream.hasReached(kStart + kMs + 1));
  EXPECT_FALSE(stream.isPast(kStart + kMs));
  EXPECT_TRUE(stream.isPast(kStart + kMs - 1));
}

TEST_F(EventStreamTest, LateAndOutsideEventsAreDroppedAndCounted) {
  take({kStart, kStart - 1, kStart - kBackLimit, kStart + 1});
  const auto outside = testing::toWire({{4, 0, kStart + 2, true}, {0, 3, kStart + 3, true}});
  stream.take(testing::wireView(outside), kSize, ++sequence);
  EXPECT_EQ(counters.events_late, 2u);
  EXPECT_EQ(counters.events_outside, 2u);
  EXPECT_EQ(counters.events_glitched, 0u);
  EXPECT_EQ(buffered(), 2u);
  checkThatNothingIsLost();
}

TEST_F(EventStreamTest, ALostArrayMakesAHoleBetweenItsNeighbours) {
  take({kStart, kStart + 10 * kMs});
  take({kStart + 20 * kMs});
  takeAs(sequence + 2, {kStart + 40 * kMs, kStart + 50 * kMs});
  EXPECT_EQ(counters.event_array_gaps, 1u);
  EXPECT_TRUE(stream.covers({kStart, kStart + 20 * kMs}));
  EXPECT_FALSE(stream.covers({kStart, kStart + 20 * kMs + 1}));
  EXPECT_FALSE(stream.covers({kStart + 40 * kMs - 1, kStart + 50 * kMs}));
  EXPECT_TRUE(stream.covers({kStart + 40 * kMs, kStart + 50 * kMs}));
}

TEST_F(EventStreamTest, AGapTellsHowManyArraysAreMissing) {
  take({kStart});
  take({kStart + 10 * kMs});
  takeAs(sequence + 4, {kStart + 40 * kMs});
  take({kStart + 50 * kMs});
  takeAs(sequence + 3, {kStart + 70 * kMs});
  EXPECT_EQ(counters.event_array_gaps, 2u);
  EXPECT_EQ(counters.event_arrays_missing, 3u + 2u);
}

TEST_F(EventStreamTest, EventsDroppedOnTheWayLeaveAHoleThatIsNoGap) {
  take({kStart, kStart + 10 * kMs});
  take({kStart + 20 * kMs});
  dropped = 5;
  stream.noteLost(dropped);
  EXPECT_FALSE(stream.covers({kStart, kStart + 20 * kMs + 1}));
  takeAs(sequence + 2, {kStart + 40 * kMs, kStart + 50 * kMs});
  EXPECT_EQ(counters.events_overflowed, 5u);
  EXPECT_EQ(counters.events_in, 3u + 5u + 2u);
  EXPECT_EQ(counters.event_array_gaps, 0u);
  EXPECT_TRUE(stream.covers({kStart, kStart + 20 * kMs}));
  EXPECT_FALSE(stream.covers({kStart + 20 * kMs, kStart + 40 * kMs}));
  EXPECT_TRUE(stream.covers({kStart + 40 * kMs, kStart + 50 * kMs}));
}

TEST_F(EventStreamTest, AHoleThatIsAnnouncedIsCountedByItsNumbers) {
  take({kStart});
  take({kStart + 10 * kMs});
  EXPECT_FALSE(stream.stopped());
  stream.noteMissing();
  EXPECT_TRUE(stream.stopped());
  EXPECT_TRUE(stream.covers({kStart, kStart + 10 * kMs}));
  EXPECT_FALSE(stream.covers({kStart, kStart + 10 * kMs + 1}));
  EXPECT_EQ(counters.event_array_gaps, 0u);
  takeAs(sequence + 4, {kStart + 40 * kMs});
  EXPECT_FALSE(stream.stopped());
  EXPECT_EQ(counters.event_array_gaps, 1u);
  EXPECT_EQ(counters.event_arrays_missing, 3u);
  EXPECT_FALSE(stream.covers({kStart + 30 * kMs, kStart + 40 * kMs}));
  take({kStart + 50 * kMs});
  EXPECT_TRUE(stream.covers({kStart + 40 * kMs, kStart + 50 * kMs}));
}

TEST_F(EventStreamTest, AHoleReachesOverEmptyArrays) {
  take({kStart});
  take({kStart + 10 * kMs});
  takeAs(sequence + 2, {});
  EXPECT_FALSE(stream.covers({kStart + 20 * kMs, kStart + 30 * kMs}));
  take({kStart + 40 * kMs});
  EXPECT_FALSE(stream.covers({kStart + 20 * kMs, kStart + 30 * kMs}));
  EXPECT_TRUE(stream.covers({kStart + 40 * kMs, kStart + 50 * kMs}));
}

TEST_F(EventStreamTest, APublisherThatStartsAnewLeavesAHoleThatIsNoGap) {
  takeAs(7, {kStart});
  takeAs(8, {kStart + 10 * kMs});
  takeAs(0, {kStart + 500 * kMs});
  takeAs(1, {kStart + 510 * kMs});
  EXPECT_EQ(counters.event_restarts, 1u);
  EXPECT_EQ(counters.event_array_gaps, 0u);
  EXPECT_TRUE(stream.covers({kStart, kStart + 10 * kMs}));
  EXPECT_FALSE(stream.covers({kStart + 490 * kMs, kStart + 505 * kMs}));
  EXPECT_TRUE(stream.covers({kStart + 500 * kMs, kStart + 510 * kMs}));
}

TEST_F(EventStreamTest, ASequenceThatStaysOrFallsMakesNoHole) {
  takeAs(7, {kStart});
  takeAs(7, {kStart + 10 * kMs});
  takeAs(0, {kStart + 20 * kMs});
  takeAs(0, {kStart + 30 * kMs});
  EXPECT_EQ(counters.event_array_gaps, 0u);
  EXPECT_TRUE(stream.covers({kStart, kStart + 30 * kMs}));
}

TEST_F(EventStreamTest, WhatTwoPublishersSendIsUsedOnce) {
  for (int i = 0; i < 6; ++i) {
    const std::int64_t start = kStart + i * 10 * kMs;
    // The last events of an array often have one time.
    const std::vector<std::int64_t> times = {start, start + 5 * kMs, start + 9 * kMs,
                                             start + 9 * kMs};
    // Numbers of their own; now this one is first, now the other.
    const std::uint32_t numbers[] = {100U + static_cast<std::uint32_t>(i),
                                     3U + static_cast<std::uint32_t>(i)};
    takeAs(numbers[i % 2], times);
    takeAs(numbers[1 - i % 2], times);
  }
  EXPECT_EQ(buffered(), 6u * 4u);
  EXPECT_EQ(counters.event_arrays, 12u);
  EXPECT_EQ(counters.event_arrays_repeated, 6u);
  EXPECT_EQ(counters.events_repeated, 6u * 4u);
  EXPECT_EQ(counters.events_late, 0u);
  EXPECT_EQ(counters.event_restarts, 0u);
  EXPECT_EQ(counters.event_array_gaps, 0u);
  EXPECT_TRUE(stream.covers({kStart, newest()}));
}

TEST_F(EventStreamTest, ASecondPublisherMayLagBehind) {
  constexpr int kLag = 20;
  const auto times = [](int i) {
    return std::vector<std::int64_t>{kStart + i * 10 * kMs, kStart + (i * 10 + 9) * kMs};
  };
  for (int i = 0; i < 3 * kLag; ++i) {
    take(times(i));
    if (i >= kLag) {
      const std::uint32_t number = sequence;
      takeAs(static_cast<std::uint32_t>(i - kLag), times(i - kLag));
      sequence = number;
    }
  }
  EXPECT_EQ(buffered(), 3u * kLag * 2u);
  EXPECT_EQ(counters.event_arrays_repeated, 2u * kLag);
  EXPECT_EQ(counters.event_restarts, 0u);
  EXPECT_TRUE(stream.covers({kStart, newest()}));
}

TEST_F(EventStreamTest, AnArrayThatEndsWithinTheLimitIsKnownAgain) {
  const std::vector<std::int64_t> across = {kStart, kStart + kBackLimit};
  takeAs(1, across);
  takeAs(2, {kStart + 2 * kBackLimit});
  takeAs(9, across);
  EXPECT_EQ(counters.event_arrays_repeated, 1u);
  EXPECT_EQ(counters.events_repeated, 2u);
  EXPECT_EQ(buffered(), 3u);
}

/// What lies around its record is not part of it.
TEST_F(EventStreamTest, AnArrayOfOneEventIsKnownAgain) {
  const Event far{1, 1, kStart + 3600 * kSecond, true};
  const auto bytes = testing::toWire({{1, 1, 0, true}, {1, 1, kStart, true}, far});
  const WireEvents one{bytes.data() + kWireEventBytes, 1};
  stream.take(one, kSize, 1);
  stream.take(one, kSize, 7);
  EXPECT_EQ(counters.event_arrays_repeated, 1u);
  EXPECT_EQ(buffered(), 1u);
}

TEST_F(EventStreamTest, AnArrayThatComesTwiceHidesNoLoss) {
  for (const std::uint32_t number : {1U, 2U, 3U, 5U, 6U}) {
    for (int twice = 0; twice < 2; ++twice) {
      takeAs(number, {kStart + number * 10 * kMs, kStart + (number * 10 + 5) * kMs});
    }
  }
  EXPECT_EQ(counters.event_arrays_repeated, 5u);
  EXPECT_EQ(counters.event_array_gaps, 1u);
  EXPECT_EQ(counters.event_arrays_missing, 1u);
}

TEST_F(EventStreamTest, AnArrayThatComesTwiceConfirmsNoJump) {
  take({kStart});
  held = 2;
  const std::vector<std::int64_t> ahead = {kStart + 20 * kSecond, kStart + 20 * kSecond + kMs};
  take(ahead);
  take(ahead);
  EXPECT_EQ(counters.event_time_jumps, 0u);
  EXPECT_EQ(counters.event_arrays_repeated, 1u);
  held = 0;
  take({kStart + kMs});
  EXPECT_EQ(counters.events_glitched, 2u);
  EXPECT_EQ(buffered(), 2u);
}

TEST_F(EventStreamTest, ARecordingThatIsPlayedAgainIsNoRepetition) {
  const std::vector<std::int64_t> first = {kStart, kStart + 10 * kMs};
  for (int pass = 0; pass < 2; ++pass) {
    takeAs(1, first);
    takeAs(2, {kStart + 600 * kMs, kStart + 610 * kMs});
  }
  EXPECT_EQ(counters.event_arrays_repeated, 0u);
  EXPECT_EQ(counters.event_time_jumps, 1u);
  EXPECT_EQ(buffered(), 4u);
}

TEST_F(EventStreamTest, AnArrayWithoutAValidSizeIsRefusedAndLeavesAHole) {
  take({kStart});
  for (const SensorSize bad : {SensorSize{0, 3}, SensorSize{4, 0}, SensorSize{32768, 3},
                               SensorSize{4, 32768}, SensorSize{-1, 3}}) {
    take({kStart + kMs}, bad);
  }
  EXPECT_EQ(counters.event_arrays_refused, 5u);
  EXPECT_EQ(counters.events_refused, 5u);
  EXPECT_EQ(counters.size_changes, 0u);
  take({kStart + 2 * kMs});
  EXPECT_FALSE(stream.covers({kStart, kStart + 2 * kMs}));
  EXPECT_TRUE(stream.covers({kStart + 2 * kMs, kStart + 3 * kMs}));
}

TEST_F(EventStreamTest, AnArrayWithoutAValidSizeIsRefusedAtTheStartToo) {
  take({kStart}, {0, 0});
  EXPECT_FALSE(stream.seen());
  EXPECT_EQ(stream.lists(), nullptr);
}

TEST_F(EventStreamTest, SensorsOfOnePixelAndOfTheLongestSidesAreValid) {
  for (const SensorSize size : {SensorSize{1, 1}, SensorSize{32767, 1}, SensorSize{1, 32767}}) {
    take({kStart}, size);
    ASSERT_NE(stream.lists(), nullptr);
    EXPECT_EQ(stream.lists()->size(), size);
  }
  EXPECT_EQ(counters.event_arrays_refused, 0u);
}

TEST_F(EventStreamTest, AnotherSizeEmptiesTheListsAndIsCounted) {
  take({kStart, kStart + kMs});
  take({kStart + 2 * kMs}, {8, 8});
  EXPECT_EQ(counters.size_changes, 1u);
  EXPECT_EQ(stream.lists()->size(), (SensorSize{8, 8}));
  EXPECT_EQ(buffered(), 1u);
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks[0], std::make_pair(StreamReset::kSizeChange, kStart + 2 * kMs));
  EXPECT_FALSE(stream.covers({kStart, kStart + kMs}));
  EXPECT_TRUE(stream.covers({kStart + 2 * kMs, kStart + 3 * kMs}));
}

TEST_F(EventStreamTest, EventsThatStayBackAreAJump) {
  take({kStart, kStart + kMs});
  const std::int64_t back = kStart - kBackLimit - kMs;
  const std::uint64_t generation = stream.generation();
  take({kStart + 2 * kMs, back, back + 1});
  EXPECT_EQ(counters.event_time_jumps, 1u);
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks[0], std::make_pair(StreamReset::kTimeJump, back));
  EXPECT_NE(stream.generation(), generation);
  EXPECT_EQ(buffered(), 2u);
  EXPECT_EQ(newest(), back + 1);
  EXPECT_TRUE(stream.covers({back, back + kMs}));
}

TEST_F(EventStreamTest, StrayEventsBackWithinAnArrayAreDropped) {
  take({kStart, 5, 6, kStart + kMs, 7, kStart + 2 * kMs});
  EXPECT_EQ(counters.event_time_jumps, 0u);
  EXPECT_EQ(counters.events_glitched, 3u);
  EXPECT_EQ(buffered(), 3u);
  EXPECT_TRUE(breaks.empty());
}

TEST_F(EventStreamTest, ALoneEventBackAtTheEndWaitsForTheNextArrayAndIsRefuted) {
  take({kStart});
  held = 1;
  take({kStart + kMs, 5});
  EXPECT_EQ(newest(), kStart + kMs);
  take({});  // says nothing
  held = 0;
  take({kStart + 2 * kMs});
  EXPECT_EQ(counters.event_time_jumps, 0u);
  EXPECT_EQ(counters.events_glitched, 1u);
  EXPECT_EQ(buffered(), 3u);
}

TEST_F(EventStreamTest, ALoneEventBackAtTheEndWaitsForTheNextArrayAndIsConfirmed) {
  take({kStart});
  held = 1;
  take({kStart + kMs, 5 * kMs});
  held = 0;
  take({6 * kMs, 7 * kMs});
  EXPECT_EQ(counters.event_time_jumps, 1u);
  EXPECT_EQ(counters.events_glitched, 0u);
  EXPECT_EQ(buffered(), 3u);
  EXPECT_EQ(newest(), 7 * kMs);
  EXPECT_TRUE(stream.covers({5 * kMs, 8 * kMs}));
}

TEST_F(EventStreamTest, AJumpAheadEntersNothingUntilTheNextArrayConfirmsIt) {
  take({kStart});
  const std::int64_t ahead = kStart + kForwardLimit + 1;
  held = 2;
  take({ahead, ahead + kMs});
  EXPECT_EQ(newest(), kStart);
  EXPECT_EQ(buffered(), 1u);
  EXPECT_EQ(counters.event_time_jumps, 0u);
  held = 0;
  take({ahead + 2 * kMs});
  EXPECT_EQ(counters.event_time_jumps, 1u);
  EXPECT_EQ(buffered(), 3u);
  EXPECT_EQ(newest(), ahead + 2 * kMs);
  ASSERT_EQ(breaks.size(), 1u);
  EXPECT_EQ(breaks[0], std::make_pair(StreamReset::kTimeJump, ahead));
}

TEST_F(EventStreamTest, AJumpAheadThatTheNextArrayRefutesIsDropped) {
  take({kStart});
  held = 1;
  take({kStart + 100 * kSecond});
  held = 0;
  take({kStart + kMs});
  EXPECT_EQ(counters.event_time_jumps, 0u);
  EXPECT_EQ(counters.events_glitched, 1u);
  EXPECT_EQ(newest(), kStart + kMs);
  EXPECT_TRUE(stream.covers({kStart, kStart + kMs}));
}

TEST_F(EventStreamTest, ExactlyTheForwardLimitIsNoJump) {
  take({kStart});
  take({kStart + kForwardLimit});
  EXPECT_EQ(newest(), kStart + kForwardLimit);
  EXPECT_EQ(counters.events_glitched, 0u);
}

TEST_F(EventStreamTest, AStrayFarAheadBeforeARealPauseIsNotTakenForTheJump) {
  take({kStart});
  held = 1;
  take({kStart + 1'000'000 * kSecond});  // stray
  take({kStart + 20 * kSecond});         // after a pause of 20 s: ahead, but nowhere near the stray
  EXPECT_EQ(counters.events_glitched, 1u);
  held = 0;
  take({kStart + 20 * kSecond + kMs});
  EXPECT_EQ(counters.event_time_jumps, 1u);
  EXPECT_EQ(newest(), kStart + 20 * kSecond + kMs);
}

TEST_F(EventStreamTest, AJumpWithinTheHeldEventsIsWorkedOffToo) {
  take({kStart});
  const std::int64_t ahead = kStart + 100 * kSecond;
  held = 2;
  take({ahead, ahead + 20 * kSecond});
  held = 0;
  take({ahead + 20 * kSecond + 1});
  EXPECT_EQ(counters.event_time_jumps, 2u);
  EXPECT_EQ(newest(), ahead + 20 * kSecond + 1);
  checkThatNothingIsLost();
}

/// However many there are: what is left then is dropped, and the array itself waits.
TEST_F(EventStreamTest, TwoJumpsWithinTheHeldEventsAreWorkedOffByOneArray) {
  take({kStart});
  const std::int64_t ahead = kStart + 100 * kSecond;
  held = 3;
  take({ahead, ahead + 20 * kSecond, ahead + 40 * kSecond});
  held = 1;
  take({ahead + 40 * kSecond + 1});
  EXPECT_EQ(counters.event_time_jumps, 2u);
  EXPECT_EQ(counters.events_glitched, 1u);
  EXPECT_EQ(newest(), ahead + 20 * kSecond);
  held = 0;
  take({ahead + 40 * kSecond + 2});
  EXPECT_EQ(counters.event_time_jumps, 3u);
  EXPECT_EQ(newest(), ahead + 40 * kSecond + 2);
}

TEST_F(EventStreamTest, AJumpBackWithinTheHeldEventsWaitsForTheNextArrayAndIsRefuted) {
  take({kStart});
  const std::int64_t ahead = kStart + 100 * kSecond;
  const std::int64_t stray = kStart + 60 * kSecond;
  held = 4;
  take({ahead, ahead + kMs, stray, stray + kMs});
  held = 0;
  take({ahead + 2 * kMs});
  EXPECT_EQ(counters.event_time_jumps, 1u);
  EXPECT_EQ(counters.events_glitched, 2u);
  EXPECT_EQ(buffered(), 3u);
  EXPECT_EQ(newest(), ahead + 2 * kMs);
}

TEST_F(EventStreamTest, AnArrayLostBehindHeldEventsMakesAHoleInTheNewEpoch) {
  take({kStart});
  const std::int64_t ahead = kStart + 100 * kSecond;
  held = 1;
  take({ahead});
  held = 0;
  takeAs(sequence + 2, {ahead + 10 * kMs, ahead + 20 * kMs});
  EXPECT_EQ(counters.event_time_jumps, 1u);
  EXPECT_FALSE(stream.covers({ahead, ahead + 10 * kMs}));
  EXPECT_TRUE(stream.covers({ahead + 10 * kMs, ahead + 20 * kMs}));
}

TEST_F(EventStreamTest, HeldEventsAreDroppedAtTheEnd) {
  take({kStart});
  held = 1;
  take({kStart + 100 * kSecond});
  stream.dropHeld();
  held = 0;
  checkThatNothingIsLost();
  EXPECT_EQ(counters.events_glitched, 1u);
}

TEST_F(EventStreamTest, OverflowIsCountedAndNotCovered) {
  constexpr std::size_t kChunk = PixelEventLists::kChunkEvents;
  stream.setLimits({kChunk, kBackLimit, kForwardLimit});
  const auto bytes = testing::toWire(testing::makeEvents(
      testing::EventScene::kUniform, {kSize, kChunk + 10, kStart, 100 * kMs, 1}));
  stream.take(testing::wireView(bytes), kSize, 1);
  EXPECT_EQ(counters.events_overflowed, kChunk);
  EXPECT_LE(buffered(), kChunk);
  EXPECT_FALSE(stream.covers({kStart, kStart + 100 * kMs}));
  EXPECT_TRUE(stream.covers({stream.lists()->completeFrom(), kStart + 100 * kMs}));
}

TEST_F(EventStreamTest, RestartMakesItStartUpAnew) {
  take({kStart});
  stream.restart();
  EXPECT_FALSE(stream.seen());
  EXPECT_FALSE(stream.covers({kStart, kStart + kMs}));
  takeAs(100, {5 * kMs, 6 * kMs});
  EXPECT_EQ(counters.event_time_jumps, 0u);
  EXPECT_EQ(counters.event_array_gaps, 0u);
  EXPECT_TRUE(stream.covers({5 * kMs, 6 * kMs}));
}

TEST_F(EventStreamTest, TheSplitIntoArraysDoesNotMatter) {
  // A stray, a late event, a jump back and one ahead; no array holds the whole time between jumps.
  std::vector<std::int64_t> times_ns;
  constexpr int kRun = 80;
  const auto run = [&](std::int64_t from_ns) {
    for (int i = 0; i < kRun; ++i) {
      times_ns.push_back(from_ns + i * kMs);
    }
  };
  run(kStart);
  times_ns.push_back(5);  // stray
  run(kStart + kRun * kMs);
  times_ns.push_back(kStart + kRun * kMs);  // late
  run(kStart - 10 * kSecond);               // jump back
  run(kStart + 30 * kSecond);               // jump ahead
  for (std::size_t length = 1; length <= 60; ++length) {
    DeblurCounters c;
    EventStream split{{1'000'000, kBackLimit, kForwardLimit}, c, [](auto, auto) {}};
    for (std::size_t at = 0; at < times_ns.size(); at += length) {
      std::vector<Event> events;
      for (std::size_t i = at; i < std::min(at + length, times_ns.size()); ++i) {
        events.push_back({0, 0, times_ns[i], true});
      }
      split.take(testing::wireView(testing::toWire(events)), kSize, 0);
    }
    const auto last = testing::toWire({{0, 0, times_ns.back() + 1, true}});
    split.take(testing::wireView(last), kSize, 0);  // confirms what ended with the last array
    EXPECT_EQ(c.event_time_jumps, 2u) << "arrays of " << length;
    EXPECT_EQ(c.events_glitched, 1u) << "arrays of " << length;
    // By itself in an array, it is one that came before.
    EXPECT_EQ(c.events_late + c.events_repeated, 1u) << "arrays of " << length;
    EXPECT_EQ(split.lists()->eventCount(), kRun + 1u) << "arrays of " << length;
    EXPECT_TRUE(split.covers({kStart + 30 * kSecond, times_ns.back()}));
  }
}

TEST_F(EventStreamTest, AnArrayWhoseTimesFallAgainAndAgainJumpsNoMoreThanACoupleOfTimes) {
  take({kStart});
  const std::int64_t back = kStart - 10 * kSecond;
  held = 2;
  take({back, back - kSecond, back - 2 * kSecond});
  EXPECT_EQ(counters.event_time_jumps, 1u);
  held = 0;
  take({back - 2 * kSecond + 1});
  EXPECT_EQ(counters.event_time_jumps, 3u);
  EXPECT_EQ(newest(), back - 2 * kSecond + 1);
  checkThatNothingIsLost();
}

TEST_F(EventStreamTest, TheWorkIsLinearInTheEventsWhateverTheirTimes) {
  constexpr std::size_t kCount = 100'000;
  constexpr std::int64_t kLateStart = 2'000'000 * kSecond;  // room to fall
  for (std::size_t i = 0; i < testing::kArrayKindCount; ++i) {
    const auto kind = static_cast<testing::ArrayKind>(i);
    DeblurCounters c;
    std::size_t jumps = 0;
    EventStream own{{10'000'000, kBackLimit, kForwardLimit}, c, [&jumps](auto, auto) { ++jumps; }};
    std::int64_t t_ns = kLateStart;
    std::uint32_t number = 0;
    for (const testing::ArrayKind next :
         {testing::ArrayKind::kRegular, kind, kind, testing::ArrayKind::kRegular}) {
      const auto bytes = testing::makeArray(next, kSize, kCount, t_ns + kMs);
      const WireEvents events = testing::wireView(bytes);
      own.take(events, kSize, ++number);
      t_ns = decodeWireEvent(events.record(kCount - 1)).t_ns;  // each array goes on from there
    }
    EXPECT_LE(own.recordsRead(), EventStream::kMostReadings * c.events_in) << toString(kind);
    EXPECT_LE(jumps, 12u) << toString(kind);
  }
}

}  // namespace
}  // namespace fast_edi
