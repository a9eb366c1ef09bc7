#include "fast_edi/events/event_log.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::size_t kChunk = EventLog::kChunkEvents;
constexpr std::size_t kPixels = 4;
constexpr std::int64_t kStart = 1'600'000'000'000'000'000;

class EventLogTest : public ::testing::Test {
 protected:
  EventLogTest() { log_.reset(kPixels, 3 * kChunk); }

  void add(std::int64_t t_ns, std::uint32_t code = 0) {
    const EventLog::Tail tail = log_.tailFor(t_ns);
    ASSERT_GE(tail.room, 1u);
    *tail.events = {static_cast<std::uint32_t>(t_ns - tail.base_ns), code};
    log_.extend(1);
  }
  /// One event each nanosecond.
  void fill(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) add(kStart + next_++, i % (2 * kPixels));
  }
  PackedEventSpan all() const { return log_.span(log_.beginSequence(), log_.endSequence()); }

  EventLog log_;
  std::int64_t next_ = 0;
};

TEST_F(EventLogTest, TailIsTheRestOfTheNewestChunk) {
  add(kStart);
  EXPECT_EQ(log_.tail().room, kChunk - 1);
  EXPECT_EQ(log_.tail().base_ns, kStart);
  EXPECT_EQ(log_.tail().events, all().data + 1);
  fill(kChunk - 1);
  EXPECT_EQ(log_.tail().room, 0u);
  EXPECT_EQ(log_.tailFor(kStart + next_).room, kChunk);
}

TEST_F(EventLogTest, TakesSeveralEventsAtOnce) {
  add(kStart);
  const EventLog::Tail tail = log_.tail();
  tail.events[0] = {5, 2};
  tail.events[1] = {7, 3};
  log_.extend(2);
  EXPECT_EQ(log_.eventCount(), 3u);
  EXPECT_EQ(log_.lowerBound(kStart + 6), 2u);
  EXPECT_EQ(all().count, 3u);
  EXPECT_EQ(all().data[2].code, 3u);
}

TEST_F(EventLogTest, ChunksEndWhereTheirTimesWouldNotFit) {
  add(kStart);
  add(kStart + EventLog::kMaxDt_ns);
  EXPECT_EQ(all().count, 2u);
  add(kStart + EventLog::kMaxDt_ns + 1);
  EXPECT_EQ(all().count, 2u);
  EXPECT_EQ(log_.span(2, 3).base_ns, kStart + EventLog::kMaxDt_ns + 1);
}

TEST_F(EventLogTest, DropsTheOldestChunkWhenFull) {
  fill(3 * kChunk);
  EXPECT_FALSE(log_.fits(1));
  EXPECT_EQ(log_.overflowed(), 0u);
  EXPECT_EQ(log_.completeFrom(), INT64_MIN);
  fill(1);
  EXPECT_EQ(log_.overflowed(), kChunk);
  EXPECT_EQ(log_.beginSequence(), kChunk);
  EXPECT_EQ(log_.endSequence(), 3 * kChunk + 1);
  EXPECT_EQ(log_.completeFrom(), kStart + static_cast<std::int64_t>(kChunk));
}

TEST_F(EventLogTest, HasNoMoreChunksThanFullOnesNeedAndOneMore) {
  // Each event begins a chunk of its own.
  for (std::int64_t i = 0; i < 5; ++i) add(kStart + i * (EventLog::kMaxDt_ns + 1));
  EXPECT_EQ(log_.eventCount(), 4u);
  EXPECT_EQ(log_.overflowed(), 1u);
}

TEST_F(EventLogTest, ACountOneAboveThatOfFullChunksNeedsAChunkMore) {
  log_.reset(kPixels, kChunk + 1);
  for (std::int64_t i = 0; i < 5; ++i) add(kStart + i * (EventLog::kMaxDt_ns + 1));
  EXPECT_EQ(log_.eventCount(), 3u);
}

TEST_F(EventLogTest, NumbersGoOnAfterAFlush) {
  fill(10);
  log_.flush();
  EXPECT_TRUE(log_.empty());
  EXPECT_EQ(log_.beginSequence(), 10u);
  add(0);
  EXPECT_EQ(log_.lowerBound(0), 10u);
  EXPECT_EQ(all().base_ns, 0);
}

TEST_F(EventLogTest, IntervalsAreTheSameWheneverTheyAreSwitchedOn) {
  const auto intervals = [this] {
    return std::vector<std::uint16_t>(all().intervals, all().intervals + all().count);
  };
  const auto addAll = [this] {
    for (std::int64_t i = 0; i < 1000; ++i) add(kStart + i * 1000, i * i % (2 * kPixels));
  };
  addAll();
  EXPECT_EQ(all().intervals, nullptr);
  log_.keepIntervals(true);
  const std::vector<std::uint16_t> afterwards = intervals();
  log_.flush();
  addAll();
  EXPECT_EQ(intervals(), afterwards);

  log_.keepIntervals(false);
  EXPECT_EQ(all().intervals, nullptr);
}

TEST_F(EventLogTest, SharedEventsStayWhileTheLogGoesOn) {
  log_.keepIntervals(true);
  fill(2 * kChunk + 100);
  EventLog shared;
  shared.share(log_, kStart + 10, kStart + 2 * kChunk + 50);
  ASSERT_EQ(shared.beginSequence(), 0u);
  ASSERT_EQ(shared.endSequence(), 2 * kChunk + 100);
  std::vector<std::uint16_t> intervals;
  for (std::uint64_t next = 0; next < shared.endSequence();) {
    const PackedEventSpan span = shared.span(next, shared.endSequence());
    intervals.insert(intervals.end(), span.intervals, span.intervals + span.count);
    next += span.count;
  }
  log_.discardBefore(kStart + 2 * kChunk);
  log_.keepIntervals(false);
  fill(3 * kChunk);  // into memory that is free again, and beyond the limit
  log_.flush();
  for (std::uint64_t next = 0; next < shared.endSequence();) {
    const PackedEventSpan span = shared.span(next, shared.endSequence());
    for (std::size_t i = 0; i < span.count; ++i, ++next) {
      ASSERT_EQ(span.base_ns + span.data[i].dt_ns, kStart + static_cast<std::int64_t>(next));
      ASSERT_EQ(span.data[i].code, next % kChunk % (2 * kPixels));
      ASSERT_EQ(span.intervals[i], intervals[next]);
    }
  }
}

TEST_F(EventLogTest, SharesOnlyChunksWithSuchEvents) {
  fill(3 * kChunk);
  EventLog shared;
  shared.share(log_, kStart + kChunk, kStart + 2 * kChunk);
  EXPECT_EQ(shared.beginSequence(), kChunk);
  EXPECT_EQ(shared.endSequence(), 2 * kChunk);
  EXPECT_EQ(shared.lowerBound(kStart + kChunk + 7), log_.lowerBound(kStart + kChunk + 7));
  EXPECT_EQ(shared.lowerBound(kStart + 2 * kChunk), log_.lowerBound(kStart + 2 * kChunk));
  EXPECT_FALSE(shared.keepsIntervals());
  shared.share(log_, kStart + 4 * kChunk, kStart + 5 * kChunk);
  EXPECT_TRUE(shared.empty());
}

TEST_F(EventLogTest, MemoryThatWasSharedIsNotWrittenAgain) {
  fill(2 * kChunk);
  EventLog shared;
  shared.share(log_, kStart, kStart + kChunk);
  const PackedEvent* const first = shared.span(0, 1).data;
  EXPECT_EQ(first, log_.span(0, 1).data) << "copied";
  log_.discardBefore(kStart + kChunk);
  fill(1);
  EXPECT_NE(log_.tail().events, first + 1);
  EXPECT_NE(log_.span(2 * kChunk, 2 * kChunk + 1).data, first);
}

}  // namespace
}  // namespace fast_edi
