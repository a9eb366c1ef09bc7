#include "hdf5/hdf5_time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {
namespace {

TEST(Hdf5Time, UnitIsTheOneThatIsSaid) {
  EXPECT_EQ(timeUnit("ns", true, 0.0, 1e6), 1);
  EXPECT_EQ(timeUnit("us", false, 0.0, 1.0), kNanosecondsPerMicrosecond);
  EXPECT_EQ(timeUnit("milliseconds", true, 0.0, 1.0), kNanosecondsPerMillisecond);
  EXPECT_EQ(timeUnit("s", true, 0.0, 1.0), kNanosecondsPerSecond);
}

TEST(Hdf5Time, UnitOfOthersIsTheLikelyOne) {
  EXPECT_EQ(timeUnit("", true, 0.0, 60e6), kNanosecondsPerMicrosecond) << "from 0";
  EXPECT_EQ(timeUnit("parsecs", true, 0.0, 60e6), kNanosecondsPerMicrosecond);
  EXPECT_EQ(timeUnit("", true, 1.6e15, 1.6e15 + 60e6), kNanosecondsPerMicrosecond) << "Unix time";
  EXPECT_EQ(timeUnit("", true, 1.6e18, 1.6e18 + 60e9), 1);
  EXPECT_EQ(timeUnit("", false, 0.0, 60.0), kNanosecondsPerSecond);
  EXPECT_EQ(timeUnit("", false, 1.6e9, 1.6e9 + 60.0), kNanosecondsPerSecond);
  EXPECT_EQ(timeUnit("", false, 0.0, 60e6), kNanosecondsPerMicrosecond) << "no 694 days";
  EXPECT_EQ(timeUnit("", false, 1.6e15, 1.6e15 + 60e6), kNanosecondsPerMicrosecond);
}

TEST(Hdf5Time, SecondsAreRoundedToMicroseconds) {
  EXPECT_EQ(timeOf(0.1234567, kNanosecondsPerSecond), 123'457'000);
  // Doubles are 0.24 us apart there.
  EXPECT_EQ(timeOf(1600000000.123456, kNanosecondsPerSecond), 1'600'000'000'123'456'000);
  EXPECT_EQ(timeOf(1500.0, 1), 2000);
}

TEST(Hdf5Time, WholeNumbersAreExact) {
  EXPECT_EQ(timeOf(std::int64_t{1'600'000'000'123'456'789}, 1), 1'600'000'000'123'456'789);
  EXPECT_EQ(timeOf(std::int64_t{7}, kNanosecondsPerMicrosecond), 7000);
}

TEST(Hdf5Time, OutsideOfStampsIsNone) {
  EXPECT_EQ(timeOf(-1e-6, kNanosecondsPerSecond), std::nullopt);
  EXPECT_EQ(timeOf(4294967296.5, kNanosecondsPerSecond), std::nullopt);
  EXPECT_EQ(timeOf(std::nan(""), kNanosecondsPerSecond), std::nullopt);
  EXPECT_EQ(timeOf(std::numeric_limits<double>::infinity(), 1), std::nullopt);
  EXPECT_EQ(timeOf(std::int64_t{-1}, 1), std::nullopt);
  EXPECT_EQ(timeOf(std::numeric_limits<std::int64_t>::max(), kNanosecondsPerSecond), std::nullopt);
}

}  // namespace
}  // namespace fast_edi
