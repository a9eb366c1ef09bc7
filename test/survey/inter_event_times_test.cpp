// Times between the events of a pixel and of its neighbours.
#include "survey/inter_event_times.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

TEST(TimeHistogramTest, OctavesHaveEightBins) {
  TimeHistogram histogram;
  EXPECT_DOUBLE_EQ(TimeHistogram::binStartNs(0), 1e3);
  EXPECT_DOUBLE_EQ(TimeHistogram::binStartNs(80), 1024e3);
  histogram.add(1'024'001);
  histogram.add(0);                // below: the first bin
  histogram.add(1'000'000 * kMs);  // beyond: the last bin
  EXPECT_EQ(histogram[80], 1U);
  EXPECT_EQ(histogram[0], 1U);
  EXPECT_EQ(histogram[TimeHistogram::kBins - 1], 1U);
  EXPECT_EQ(histogram.sum(0, 81), 2U);
  EXPECT_EQ(histogram.total(), 3U);
}

TEST(InterEventTimesTest, CountsPixelsByTheirShortestTime) {
  InterEventTimes times({4, 3});
  times.restart(0);
  for (const std::int64_t ms : {10, 30, 35}) {
    times.add({3, 2, ms * kMs, true});  // shortest: 5 ms
  }
  for (const std::int64_t ms : {40, 60}) {
    times.add({0, 0, ms * kMs, true});  // 20 ms
  }
  times.add({1, 1, 60 * kMs, true});  // once
  EXPECT_EQ(times.ofPixels().total(), 3U);
  EXPECT_EQ(times.ofNeighbours().total(), 6U);
  EXPECT_EQ(times.pixelsWithShortest(0.0, 5.0 * kMs), 0U);
  EXPECT_EQ(times.pixelsWithShortest(5.0 * kMs, 20.0 * kMs), 1U);
  EXPECT_EQ(times.pixelsWithShortest(5.0 * kMs, 21.0 * kMs), 2U);
}

TEST(InterEventTimesTest, PixelsAtTheEdgesAreNoNeighboursOfTheOppositeEdge) {
  InterEventTimes times({4, 3});
  times.restart(0);
  times.add({3, 0, 90 * kMs, true});
  times.add({0, 1, 100 * kMs, true});  // next in memory
  // Neither has a neighbour that fired: the times since the start, above 64 ms.
  std::size_t bin = 0;
  while (TimeHistogram::binStartNs(bin) < 64.0 * kMs) {
    ++bin;
  }
  EXPECT_EQ(times.ofNeighbours().sum(bin, TimeHistogram::kBins), 2U);
}

}  // namespace
}  // namespace fast_edi
