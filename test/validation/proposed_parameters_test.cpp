#include "validation/proposed_parameters.hpp"

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

RecordingSurvey surveyOf(std::int64_t assumed_exposure_us, bool exposures) {
  AssumedParameters assumed;
  assumed.exposure_time_ns = assumed_exposure_us * kNanosecondsPerMicrosecond;
  RecordingSurvey survey(assumed);
  if (exposures) {
    survey.addExposure(10'000, 0);
  }
  return survey;
}

TEST(ProposedParameters, StampsOffsetAndMappingAreAlwaysThere) {
  ParameterProposal proposal;
  proposal.stamp_reference = ExposureInstant::kStart;
  proposal.time_offset_us = -1500;
  proposal.event_mapping = {EventPolarity::kInverted, EventOrientation::kFlipY};
  EXPECT_THAT(proposedOverrides(proposal, surveyOf(0, true)),
              ElementsAre("stamp_reference:=start", "time_offset_us:=-1500",
                          "event_polarity:=inverted", "event_orientation:=flip_y"));
}

TEST(ProposedParameters, AnExposureIsForThoseThatAreNotRecorded) {
  ParameterProposal proposal;
  proposal.exposure_time_us = 12'000;
  EXPECT_THAT(
      proposedOverrides(proposal, surveyOf(0, false)),
      AllOf(Contains("exposure_time_us:=12000"), Not(Contains(HasSubstr("exposure_source")))));
}

TEST(ProposedParameters, AnExposureReplacesThoseThatAreWrong) {
  ParameterProposal proposal;
  proposal.exposure_time_us = 12'000;
  EXPECT_THAT(proposedOverrides(proposal, surveyOf(0, true)),
              AllOf(Contains("exposure_time_us:=12000"), Contains("exposure_source:=parameter")));
  // The one that was given already: nothing new.
  EXPECT_THAT(proposedOverrides(proposal, surveyOf(12'000, true)),
              Not(Contains(HasSubstr("exposure"))));
}

TEST(ProposedParameters, ThresholdsWhereTheyAreProposed) {
  ParameterProposal proposal;
  EXPECT_THAT(proposedOverrides(proposal, surveyOf(0, true)), Not(Contains(HasSubstr("contrast"))));
  proposal.thresholds = ContrastThresholds{0.31249, 0.2};
  EXPECT_THAT(
      proposedOverrides(proposal, surveyOf(0, true)),
      AllOf(Contains("contrast_threshold_on:=0.312"), Contains("contrast_threshold_off:=0.200")));
}

}  // namespace
}  // namespace fast_edi
