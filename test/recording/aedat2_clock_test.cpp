#include "recording/aedat2_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fast_edi {
namespace {

constexpr std::int64_t kWrap_us = std::int64_t{1} << 32;
constexpr std::uint32_t kLast_us = std::numeric_limits<std::uint32_t>::max();

TEST(Aedat2Clock, GoesOnWhereTimesWrapAround) {
  Aedat2Clock camera_clock;
  camera_clock.advance(camera_clock.unwrapped(kLast_us));
  EXPECT_EQ(camera_clock.unwrapped(5), kWrap_us + 5);
  EXPECT_EQ(camera_clock.latest(), (kWrap_us - 1) * kNanosecondsPerMicrosecond)
      << "only asked so far";
  camera_clock.advance(camera_clock.unwrapped(5));
  EXPECT_EQ(camera_clock.unwrapped(6), kWrap_us + 6);
  EXPECT_EQ(camera_clock.latest(), (kWrap_us + 5) * kNanosecondsPerMicrosecond);
}

TEST(Aedat2Clock, TakesLessThanHalfAWrapAsATimeThatGoesBack) {
  Aedat2Clock camera_clock;
  camera_clock.advance(camera_clock.unwrapped(1000));
  camera_clock.advance(camera_clock.unwrapped(10));
  EXPECT_EQ(camera_clock.unwrapped(11), 11);
  EXPECT_EQ(camera_clock.latest(), 1000 * kNanosecondsPerMicrosecond);
}

TEST(Aedat2Clock, StopsToWrapAfterMoreThanARecordingLasts) {
  Aedat2Clock camera_clock;
  constexpr std::int64_t kMoreThanAreTaken = 1100;
  for (std::int64_t i = 0; i < kMoreThanAreTaken; ++i) {
    camera_clock.advance(camera_clock.unwrapped(0));
    camera_clock.advance(camera_clock.unwrapped(kLast_us));
  }
  EXPECT_EQ(camera_clock.unwrapped(0), 1000 * kWrap_us);
  EXPECT_EQ(camera_clock.latest(), (1001 * kWrap_us - 1) * kNanosecondsPerMicrosecond);
}

}  // namespace
}  // namespace fast_edi
