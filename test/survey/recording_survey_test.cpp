// What the first pass gathers.
#include "survey/recording_survey.hpp"

#include <gtest/gtest.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using testing::SyntheticRecording;

constexpr std::int64_t kMs = SyntheticRecording::kMs;

TEST(RecordingSurveyTest, CountsTheMessages) {
  const RecordingSurvey survey = SyntheticRecording{}.run();
  EXPECT_EQ(survey.frames().frames().size(), 12U);
  EXPECT_EQ(survey.timeline().events(), 50'000U);
  ASSERT_NE(survey.statistics(), nullptr);
  EXPECT_EQ(survey.statistics()->size(), SyntheticRecording::kSize);
  EXPECT_EQ(survey.eventSizes().size(), 1U);
  EXPECT_EQ(survey.typicalExposureUs(), 20'000);
  EXPECT_TRUE(survey.exposuresPlausible());
  EXPECT_LT(std::abs(survey.roughClockOffsetNs()), 30 * kMs);
}

TEST(RecordingSurveyTest, TakesExposuresAsTheParametersSay) {
  SyntheticRecording recording;
  recording.parameters.stamp_reference = ExposureInstant::kStart;
  recording.parameters.time_offset_ns = 2 * kMs;
  RecordingSurvey survey = recording.run();
  const LoggedFrame& frame = survey.frames().frames()[3];
  EXPECT_EQ(*survey.assumedExposure(frame),
            (ExposureInterval{frame.stamp_ns + 2 * kMs, frame.stamp_ns + 22 * kMs}));

  recording.parameters.exposure_from_parameter = true;
  recording.parameters.exposure_time_ns = 7 * kMs;
  EXPECT_EQ(recording.run().assumedLengthNs(frame), 7 * kMs);
  recording.parameters.exposure_time_ns = 0;
  EXPECT_FALSE(recording.run().assumedExposure(frame));
}

TEST(RecordingSurveyTest, SeesClocksThatDiffer) {
  SyntheticRecording recording;
  recording.event_stamp = [](std::int64_t t) { return t + 5'000 * kMs; };
  EXPECT_NEAR(static_cast<double>(recording.run().roughClockOffsetNs()), 5'000.0 * kMs, 30.0 * kMs);
}

}  // namespace
}  // namespace fast_edi
