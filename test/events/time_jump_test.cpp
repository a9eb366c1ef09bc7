#include "fast_edi/events/time_jump.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kNewest = 100 * kSecond;
constexpr std::int64_t kForwardLimit = 10 * kSecond;

std::size_t runLength(bool forward, const std::vector<std::int64_t>& times_ns) {
  std::vector<Event> events;
  for (const std::int64_t t_ns : times_ns) {
    events.push_back({0, 0, t_ns, true});
  }
  const auto bytes = testing::toWire(events);
  return TimeJump{kNewest, forward, kForwardLimit}.runLength(testing::wireView(bytes));
}

TEST(TimeJump, AStrayEventEndsWhereTheTimesReturn) {
  EXPECT_EQ(runLength(false, {kNewest - 5 * kSecond, kNewest + 1, kNewest + 2}), 1u);
  EXPECT_EQ(runLength(true, {kNewest + 50 * kSecond, kNewest + 1, kNewest + 2}), 1u);
}

TEST(TimeJump, AStrayBeforeALateEventIsStillAStray) {
  EXPECT_EQ(runLength(false, {kNewest - 5 * kSecond, kNewest - 10}), 1u);
}

TEST(TimeJump, ARunReachesAsFarAsTheTimesStay) {
  EXPECT_EQ(runLength(false, {0, 1, 2, 3}), 4u);
  EXPECT_EQ(runLength(true, {kNewest + 50 * kSecond, kNewest + 50 * kSecond + 1}), 2u);
  EXPECT_EQ(runLength(false, {0, 1, kNewest + 1}), 2u);
}

TEST(TimeJump, AnArrayThatJumpsBackStaysOneRunWhenItComesCloseToTheOldTime) {
  // Back by 0.6 s, then events on and on into the last 0.5 s before the old newest event.
  std::vector<std::int64_t> times_ns;
  for (std::int64_t ms = 600; ms > 100; ms -= 20) {
    times_ns.push_back(kNewest - ms * kNanosecondsPerMillisecond);
  }
  EXPECT_EQ(runLength(false, times_ns), times_ns.size());
}

TEST(TimeJump, AheadEndsWithinTheLimitEvenWhenNearerToTheRun) {
  EXPECT_EQ(runLength(true, {kNewest + 11 * kSecond, kNewest + 9 * kSecond}), 1u);
}

TEST(TimeJump, TimesAtBothEndsOfTheClockDoNotOverflow) {
  constexpr std::int64_t kLast = ((std::int64_t{1} << 32) - 1) * kSecond;
  const TimeJump back{kLast, false, kForwardLimit};
  EXPECT_TRUE(back.continues(0, 1));
  const TimeJump ahead{0, true, kForwardLimit};
  EXPECT_TRUE(ahead.continues(kLast - 1, kLast));
}

}  // namespace
}  // namespace fast_edi
