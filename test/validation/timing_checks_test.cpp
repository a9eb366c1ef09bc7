// From an estimate to what is to be set.
#include "validation/timing_checks.hpp"

#include <gmock/gmock.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::namesOf;
using ::testing::Not;
using testing::SyntheticRecording;

constexpr double kMs = static_cast<double>(SyntheticRecording::kMs);

TimingEstimate estimate(double shift_ms) {
  TimingEstimate result;
  result.told = true;
  result.samples = 10;
  result.correlation = 0.9;
  result.shift_ns = shift_ms * kMs;
  result.shift_sigma_ns = 0.2 * kMs;
  result.offset_ns = result.shift_ns;
  result.length_ns = 20.0 * kMs;
  result.length_told = true;
  result.length_sigma = 0.03;
  result.thresholds = {0.25, 0.25};
  return result;
}

TimingVerdict judge(const TimingEstimate& estimate, const SyntheticRecording& recording = {}) {
  return judgeTiming(recording.run(), estimate, std::nullopt);
}

TEST(TimingChecksTest, WithinATenthOfTheExposureStampsAreAsAssumed) {
  for (const double shift_ms : {-1.9, 0.0, 1.9}) {
    const TimingVerdict verdict = judge(estimate(shift_ms));
    EXPECT_THAT(verdict.findings, IsEmpty()) << shift_ms;
    EXPECT_EQ(verdict.proposal.stamp_reference, ExposureInstant::kMid);
    EXPECT_EQ(verdict.proposal.time_offset_us, 0);
  }
}

TEST(TimingChecksTest, StartAndEndAreNamedOtherShiftsAreOffsets) {
  const TimingVerdict start = judge(estimate(9.0));
  EXPECT_THAT(namesOf(start.findings), ElementsAre("timing"));
  EXPECT_EQ(start.proposal.stamp_reference, ExposureInstant::kStart);
  EXPECT_EQ(start.proposal.time_offset_us, 0);
  EXPECT_EQ(judge(estimate(-11.0)).proposal.stamp_reference, ExposureInstant::kEnd);
  const TimingVerdict offset = judge(estimate(5.04));
  EXPECT_EQ(offset.proposal.stamp_reference, ExposureInstant::kMid);
  EXPECT_EQ(offset.proposal.time_offset_us, 5000);
  EXPECT_THAT(offset.findings.at(0).set, HasSubstr("time_offset_us: 5000"));
}

TEST(TimingChecksTest, ParametersThatAreSetAlreadyAreNoFinding) {
  SyntheticRecording recording;
  recording.parameters.stamp_reference = ExposureInstant::kStart;
  EXPECT_THAT(judge(estimate(10.0), recording).findings, IsEmpty());
  recording.parameters.time_offset_ns = static_cast<std::int64_t>(4.0 * kMs);
  const TimingVerdict verdict = judge(estimate(14.0), recording);
  EXPECT_THAT(verdict.findings, IsEmpty());
  EXPECT_EQ(verdict.proposal.time_offset_us, 4000);
}

TEST(TimingChecksTest, VaryingExposuresTellStampsFromOffsets) {
  TimingEstimate separated = estimate(16.0);
  separated.reference = ExposureInstant::kStart;
  separated.offset_ns = 6.0 * kMs;
  const TimingVerdict verdict = judge(separated);
  EXPECT_EQ(verdict.proposal.stamp_reference, ExposureInstant::kStart);
  EXPECT_EQ(verdict.proposal.time_offset_us, 6000);
  separated.lengths_one_late = true;
  EXPECT_THAT(namesOf(judge(separated).findings), ElementsAre("timing", "exposure-of-next-frame"));
}

TEST(TimingChecksTest, WhatCannotBeToldIsSaid) {
  TimingEstimate none;
  none.reason = "a reason";
  const TimingVerdict verdict = judge(none);
  EXPECT_THAT(verdict.findings, IsEmpty());
  EXPECT_THAT(verdict.notes, ElementsAre(HasSubstr("cannot be told: a reason")));
  TimingEstimate vague = estimate(8.0);
  vague.shift_sigma_ns = 5.0 * kMs;
  EXPECT_THAT(judge(vague).notes, ElementsAre(HasSubstr("uncertain by 5.0 ms")));
}

TEST(TimingChecksTest, LengthAndThresholdsAreJudged) {
  TimingEstimate wrong = estimate(0.0);
  wrong.length_factor = 2.0;
  const TimingVerdict verdict = judge(wrong);
  EXPECT_THAT(namesOf(verdict.findings), ElementsAre("exposure-wrong"));
  EXPECT_EQ(verdict.proposal.exposure_time_us, 40'000);

  SyntheticRecording given;
  given.parameters.thresholds_given = true;
  TimingEstimate doubled = estimate(0.0);
  doubled.thresholds = {0.5, 0.5};
  doubled.threshold_sigmas = {0.1, 0.1};
  EXPECT_THAT(namesOf(judge(doubled, given).findings), ElementsAre("contrast"));
  EXPECT_THAT(judge(doubled, given).findings[0].set, HasSubstr("contrast_threshold_on: 0.50"));
  EXPECT_EQ(judge(doubled, given).proposal.thresholds, doubled.thresholds);
  EXPECT_THAT(judge(doubled).findings, IsEmpty());
  EXPECT_EQ(judge(doubled).proposal.thresholds, doubled.thresholds);  // none were given
  doubled.threshold_sigmas = {0.6, 0.6};
  EXPECT_THAT(judge(doubled, given).findings, IsEmpty());
  EXPECT_EQ(judge(doubled, given).proposal.thresholds, std::nullopt);
}

TEST(TimingChecksTest, ThresholdsThatWouldBeWarnedOfAreNoProposal) {
  SyntheticRecording given;
  given.parameters.thresholds_given = true;
  TimingEstimate unusual = estimate(0.0);
  unusual.threshold_sigmas = {0.1, 0.1};
  unusual.thresholds = {0.85, 0.66};
  TimingVerdict verdict = judge(unusual, given);
  EXPECT_THAT(namesOf(verdict.findings), ElementsAre("contrast"));
  EXPECT_THAT(verdict.findings[0].set, Not(HasSubstr("contrast_threshold_on")));
  EXPECT_EQ(verdict.proposal.thresholds, std::nullopt);
  EXPECT_EQ(judge(unusual).proposal.thresholds, std::nullopt);
  EXPECT_THAT(verdict.notes,
              Contains(AllOf(HasSubstr("ON 0.85 +- 0.09"),
                             HasSubstr("not proposed, because the ON contrast threshold"))));
  unusual.frames_stretched = true;
  verdict = judge(unusual, given);
  EXPECT_THAT(namesOf(verdict.findings), ElementsAre("contrast", "frames-stretched"));
  EXPECT_THAT(verdict.notes, Contains(HasSubstr("these frames were stretched")));
}

TEST(TimingChecksTest, AnUnknownExposureIsProposed) {
  SyntheticRecording recording;
  recording.exposure_us = [](int) { return -1; };
  EXPECT_EQ(judge(estimate(0.0), recording).proposal.exposure_time_us, 20'000);
  TimingEstimate vague = estimate(0.0);
  vague.length_told = false;
  const TimingVerdict verdict = judge(vague, recording);
  EXPECT_EQ(verdict.proposal.exposure_time_us, 0);
  EXPECT_THAT(verdict.notes, ::testing::Contains(HasSubstr("length of the exposure cannot")));
}

TEST(TimingChecksTest, ExposuresThatEventsShowComeFirst) {
  ExposuresByEvents seen;
  seen.length_ns = 20.0 * kMs;
  seen.shift_ns = 10.1 * kMs;
  const TimingVerdict verdict = judgeTiming(SyntheticRecording{}.run(), TimingEstimate{}, seen);
  EXPECT_EQ(verdict.proposal.stamp_reference, ExposureInstant::kStart);
  EXPECT_THAT(namesOf(verdict.findings), ElementsAre("timing"));
}

}  // namespace
}  // namespace fast_edi
