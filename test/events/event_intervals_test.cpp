#include "fast_edi/events/event_intervals.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/base/level_model.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kTick = kIntervalTick_ns;
constexpr std::int64_t kBase = 1'600'000'000 * kNanosecondsPerSecond;
constexpr std::uint16_t kLong = UINT16_MAX;

/// One event after the other, at any time.
class EventIntervalsTest : public ::testing::Test {
 protected:
  EventIntervalsTest() { intervals_.reset(4); }

  std::uint16_t at(std::int64_t t_ns, std::uint32_t pixel) {
    const PackedEvent event{0, 2 * pixel};
    std::uint16_t ticks = 0;
    intervals_.measure(&event, 1, t_ns, &ticks);
    return ticks;
  }

  EventIntervals intervals_;
};

TEST_F(EventIntervalsTest, CountTicksSinceTheEventBeforeInThePixel) {
  EXPECT_EQ(at(kBase, 0), kLong);
  EXPECT_EQ(at(kBase, 1), kLong);
  EXPECT_EQ(at(kBase + 10 * kTick, 0), 9);
  EXPECT_EQ(at(kBase + 30 * kTick, 1), 29);
  EXPECT_EQ(at(kBase + 30 * kTick, 0), 19);
  EXPECT_EQ(at(kBase + 30 * kTick, 0), 0);
  EXPECT_EQ(at(kBase + 31 * kTick, 0), 0);
  EXPECT_EQ(at(kBase + (31 + 65535) * kTick, 0), 65534);
  EXPECT_EQ(at(kBase + (31 + 65535 + 65537) * kTick, 0), kLong);
}

TEST_F(EventIntervalsTest, AreNeverLongerThanTheTrueOnes) {
  std::mt19937_64 random(3);
  std::int64_t t_ns = kBase;
  at(t_ns, 0);
  for (int i = 0; i < 10'000; ++i) {
    const auto step_ns = static_cast<std::int64_t>(random() % (3 * kTick));
    t_ns += step_ns;
    const std::int64_t interval_ns = at(t_ns, 0) * kTick;
    ASSERT_TRUE(interval_ns < step_ns || interval_ns == 0);
    ASSERT_GT(interval_ns, step_ns - 2 * kTick);
  }
}

TEST_F(EventIntervalsTest, DoNotDependOnHowEventsAreCut) {
  std::mt19937 random(4);
  std::vector<PackedEvent> events(1000);
  std::uint32_t dt_ns = 0;
  for (PackedEvent& event : events) {
    dt_ns += static_cast<std::uint32_t>(random() % 100'000);
    event = {dt_ns, static_cast<std::uint32_t>(random() % 8)};
  }
  std::vector<std::uint16_t> whole(events.size());
  intervals_.measure(events.data(), events.size(), kBase, whole.data());
  for (const std::size_t packet : {1, 7, 100}) {
    std::vector<std::uint16_t> cut(events.size());
    intervals_.reset(4);
    for (std::size_t i = 0; i < events.size(); i += packet) {
      intervals_.measure(events.data() + i, std::min(packet, events.size() - i), kBase,
                         cut.data() + i);
    }
    EXPECT_EQ(cut, whole);
  }
}

TEST_F(EventIntervalsTest, NoSilenceIsSoLongThatItLooksShort) {
  // 2^32 ticks: what the stored times count up to.
  constexpr std::int64_t kTurn_ns = kTick << 32;
  // In one jump.
  at(kBase, 0);
  EXPECT_EQ(at(kBase + kTurn_ns + 10 * kTick, 0), kLong);
  // While another pixel goes on.
  for (const std::int64_t step_ns : {kTurn_ns / 3, kTurn_ns / 64}) {
    const std::int64_t start_ns = kBase + 10 * kTurn_ns;
    intervals_.reset(4);
    at(start_ns, 0);
    for (std::int64_t t_ns = start_ns; t_ns < start_ns + kTurn_ns; t_ns += step_ns) {
      EXPECT_EQ(at(t_ns, 1), kLong);
    }
    EXPECT_EQ(at(start_ns + kTurn_ns + 10 * kTick, 0), kLong);
  }
}

TEST_F(EventIntervalsTest, BeginAnewAfterAReset) {
  at(kBase, 0);
  intervals_.reset(4);
  EXPECT_EQ(at(kBase + 10 * kTick, 0), kLong);
  intervals_.reset(4);
  EXPECT_EQ(at(kBase - kNanosecondsPerSecond, 0), kLong);  // the clock went back
  EXPECT_GE(intervals_.memoryBytes(), 16u);
  intervals_.release();
  EXPECT_EQ(intervals_.memoryBytes(), 0u);
}

}  // namespace
}  // namespace fast_edi
