#include "recording/record_clock.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kHour = 3600 * kSecond;

TEST(RecordClock, FollowsTimesThatGoOnAndNoneThatGoBack) {
  RecordClock clock;
  EXPECT_EQ(clock.advance(5 * kSecond), 5 * kSecond);
  EXPECT_EQ(clock.advance(15 * kSecond), 15 * kSecond);
  EXPECT_EQ(clock.advance(2 * kSecond), 15 * kSecond);
  EXPECT_FALSE(clock.isAhead());
  EXPECT_FALSE(clock.refutedBy());
}

TEST(RecordClock, ATimeFarAheadMovesNothingByItself) {
  RecordClock clock;
  clock.advance(kSecond);
  EXPECT_EQ(clock.advance(kHour), kSecond);
  EXPECT_TRUE(clock.isAhead());
  EXPECT_EQ(clock.advance(2 * kSecond), 2 * kSecond);
  EXPECT_FALSE(clock.isAhead());
  EXPECT_EQ(clock.refutedBy(), kHour - kSecond);
  EXPECT_EQ(clock.advance(3 * kSecond), 3 * kSecond);
  EXPECT_FALSE(clock.refutedBy());
}

TEST(RecordClock, TheNextTimeConfirmsAPause) {
  RecordClock clock;
  clock.advance(kSecond);
  clock.advance(kHour);
  EXPECT_EQ(clock.advance(kHour + kSecond), kHour + kSecond);
  EXPECT_FALSE(clock.refutedBy());
  EXPECT_EQ(clock.advance(kHour - kSecond), kHour + kSecond);
}

TEST(RecordClock, WrongTimesThatDifferConfirmNothing) {
  RecordClock clock;
  clock.advance(kSecond);
  EXPECT_EQ(clock.advance(kHour), kSecond);
  EXPECT_EQ(clock.advance(3 * kHour), kSecond);
  EXPECT_EQ(clock.refutedBy(), kHour - kSecond);
  EXPECT_TRUE(clock.isAhead());
  EXPECT_EQ(clock.advance(kSecond + 1), kSecond + 1);
}

}  // namespace
}  // namespace fast_edi
