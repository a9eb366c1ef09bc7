#include "node/latency_record.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(LatencyRecord, SaysZeroWhenEmpty) {
  EXPECT_EQ(LatencyRecord().percentile(0.5), 0);
}

TEST(LatencyRecord, TakesTheNearestRank) {
  LatencyRecord record;
  for (std::int64_t i = 100; i >= 1; --i) {
    record.add(i);
  }
  EXPECT_EQ(record.percentile(0.5), 50);
  EXPECT_EQ(record.percentile(0.99), 99);
  EXPECT_EQ(record.percentile(1.0), 100);
  EXPECT_EQ(record.percentile(0.001), 1);
}

TEST(LatencyRecord, DiscardsTheOldest) {
  LatencyRecord record;
  for (std::size_t i = 0; i < LatencyRecord::kCapacity; ++i) {
    record.add(1'000'000);
  }
  for (std::size_t i = 0; i < LatencyRecord::kCapacity; ++i) {
    record.add(7);
  }
  EXPECT_EQ(record.percentile(1.0), 7);
}

}  // namespace
}  // namespace fast_edi
