// Polarities, times between events, and pixels that never rest.
#include "survey/event_statistics.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

std::size_t binOf(std::int64_t time_ns) {
  std::size_t bin = 0;
  while (bin + 1 < TimeHistogram::kBins &&
         TimeHistogram::binStartNs(bin + 1) <= static_cast<double>(time_ns)) {
    ++bin;
  }
  return bin;
}

TEST(EventStatisticsTest, MeasuresTimesToPixelAndNeighbours) {
  EventStatistics statistics({8, 8});
  statistics.add({0, 0, 1'000 * kMs, true});
  statistics.add({1, 1, 1'003 * kMs, false});
  statistics.add({1, 1, 1'010 * kMs, false});
  statistics.add({7, 7, 1'011 * kMs, true});
  statistics.add({8, 0, 1'012 * kMs, true});
  EXPECT_EQ(statistics.on(), 2U);
  EXPECT_EQ(statistics.off(), 2U);
  EXPECT_EQ(statistics.outside(), 1U);
  EXPECT_EQ(statistics.pixelTimes().total(), 1U);
  EXPECT_EQ(statistics.pixelTimes()[binOf(7 * kMs)], 1U);
  EXPECT_EQ(statistics.neighbourTimes()[binOf(3 * kMs)], 1U);
  EXPECT_EQ(statistics.neighbourTimes()[binOf(10 * kMs)], 1U);
  // Nothing around (7, 7) ever fired: at least the time since the start.
  EXPECT_EQ(statistics.neighbourTimes()[binOf(11 * kMs)], 1U);
}

TEST(EventStatisticsTest, TimesDoNotReachOverAJump) {
  EventStatistics statistics({8, 8});
  statistics.add({1, 1, 1'000 * kMs, true});
  statistics.restart(500 * kMs);
  statistics.add({1, 1, 500 * kMs, true});
  EXPECT_EQ(statistics.pixelTimes().total(), 0U);
}

TEST(EventStatisticsTest, AHotPixelFiresAlwaysAndFarMoreThanOthers) {
  EventStatistics statistics({16, 16});
  for (int ms = 0; ms < 1000; ++ms) {
    const std::int64_t t_ns = ms * kMs;
    statistics.add({4, 5, t_ns, true});
    if (ms < 300) {
      statistics.add({2, 12, t_ns, true});  // busy for a while only
    }
    for (std::uint16_t x = 8; x < 16; ++x) {  // many busy pixels beside each other
      for (std::uint16_t y = 0; y < 16; ++y) {
        if (ms % 10 == 0) {
          statistics.add({x, y, t_ns, false});
        }
      }
    }
  }
  const std::vector<HotPixel> hot = statistics.hotPixels();
  ASSERT_EQ(hot.size(), 1U);
  EXPECT_EQ(hot[0].x, 4);
  EXPECT_EQ(hot[0].y, 5);
  EXPECT_NEAR(hot[0].rate_hz, 1000.0, 5.0);
}

}  // namespace
}  // namespace fast_edi
