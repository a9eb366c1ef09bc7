#include "fast_edi/events/sequence_gaps.hpp"

#include <cstdint>
#include <initializer_list>
#include <vector>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using Step = SequenceStep;

std::vector<Step> stepsOf(SequenceGaps& gaps, std::initializer_list<std::uint32_t> sequence) {
  std::vector<Step> steps;
  for (const std::uint32_t number : sequence) {
    steps.push_back(gaps.step(number));
  }
  return steps;
}

std::vector<Step> stepsOf(std::initializer_list<std::uint32_t> sequence) {
  SequenceGaps gaps;
  return stepsOf(gaps, sequence);
}

TEST(SequenceGaps, ConsecutiveNumbersHaveNoGap) {
  EXPECT_THAT(stepsOf({7, 8, 9, 10}), Each(Step::kNothingMissing));
}

TEST(SequenceGaps, ANumberLeftOutOfAGrowingSequenceIsAGap) {
  EXPECT_THAT(stepsOf({1, 2, 4, 5, 100}),
              ElementsAre(Step::kNothingMissing, Step::kNothingMissing, Step::kGap,
                          Step::kNothingMissing, Step::kGap));
}

TEST(SequenceGaps, TheFirstStepSaysNothing) {
  EXPECT_THAT(stepsOf({5, 9, 10}), Each(Step::kNothingMissing));
}

TEST(SequenceGaps, NumbersThatDoNotGrowSayNothing) {
  EXPECT_THAT(stepsOf({0, 0, 0, 5, 5, 3, 0}), Each(Step::kNothingMissing));
}

TEST(SequenceGaps, APublisherThatStartsAnewIsNoGap) {
  SequenceGaps gaps;
  EXPECT_THAT(stepsOf(gaps, {41, 42, 43}), Each(Step::kNothingMissing));
  EXPECT_EQ(gaps.step(0), Step::kRestart);
  EXPECT_THAT(stepsOf(gaps, {1, 2}), Each(Step::kNothingMissing));
  EXPECT_EQ(gaps.step(4), Step::kGap);
  EXPECT_EQ(gaps.step(1), Step::kRestart) << "as a publisher in Python begins";
}

TEST(SequenceGaps, WrappingAroundIsNoGap) {
  EXPECT_THAT(stepsOf({0xfffffffe, 0xffffffff, 0, 1}), Each(Step::kNothingMissing));
}

TEST(SequenceGaps, RestartForgetsTheLastNumber) {
  SequenceGaps gaps;
  stepsOf(gaps, {10, 11});
  gaps.restart();
  EXPECT_THAT(stepsOf(gaps, {1, 20}), Each(Step::kNothingMissing));
}

}  // namespace
}  // namespace fast_edi
