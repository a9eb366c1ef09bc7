#include "fast_edi/core/sequence_gaps.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(SequenceGaps, ConsecutiveNumbersHaveNoGap) {
  SequenceGaps gaps;
  for (std::uint32_t sequence : {7u, 8u, 9u, 10u}) {
    EXPECT_FALSE(gaps.isAfterGap(sequence)) << sequence;
  }
}

TEST(SequenceGaps, ANumberLeftOutOfAGrowingSequenceIsAGap) {
  SequenceGaps gaps;
  gaps.isAfterGap(1);
  gaps.isAfterGap(2);
  EXPECT_TRUE(gaps.isAfterGap(4));
  EXPECT_FALSE(gaps.isAfterGap(5));
  EXPECT_TRUE(gaps.isAfterGap(100));
}

TEST(SequenceGaps, TheFirstStepSaysNothing) {
  SequenceGaps gaps;
  EXPECT_FALSE(gaps.isAfterGap(5));
  EXPECT_FALSE(gaps.isAfterGap(9));
  EXPECT_FALSE(gaps.isAfterGap(10));
}

TEST(SequenceGaps, NumbersThatDoNotGrowSayNothing) {
  SequenceGaps gaps;
  for (std::uint32_t sequence : {0u, 0u, 0u, 5u, 5u, 3u, 0u}) {
    EXPECT_FALSE(gaps.isAfterGap(sequence)) << sequence;
  }
}

TEST(SequenceGaps, APublisherThatStartsAnewIsNoGap) {
  SequenceGaps gaps;
  for (std::uint32_t sequence : {41u, 42u, 43u, 0u, 1u, 2u}) {
    EXPECT_FALSE(gaps.isAfterGap(sequence)) << sequence;
  }
  EXPECT_TRUE(gaps.isAfterGap(4));
}

TEST(SequenceGaps, WrappingAroundIsNoGap) {
  SequenceGaps gaps;
  for (std::uint32_t sequence : {0xfffffffeu, 0xffffffffu, 0u, 1u}) {
    EXPECT_FALSE(gaps.isAfterGap(sequence)) << sequence;
  }
}

TEST(SequenceGaps, RestartForgetsTheLastNumber) {
  SequenceGaps gaps;
  gaps.isAfterGap(1);
  gaps.isAfterGap(2);
  gaps.restart();
  EXPECT_FALSE(gaps.isAfterGap(10));
  EXPECT_FALSE(gaps.isAfterGap(20));
}

}  // namespace
}  // namespace fast_edi
