// Times without events.
#include "validation/coverage_checks.hpp"

#include <gmock/gmock.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::namesOf;
using testing::SyntheticRecording;

constexpr std::int64_t kMs = SyntheticRecording::kMs;

TEST(CoverageChecksTest, ASoundRecordingHasNone) {
  EXPECT_THAT(checkCoverage(SyntheticRecording{}.run()), IsEmpty());
  EXPECT_FALSE(exposuresByEvents(SyntheticRecording{}.run()));
}

TEST(CoverageChecksTest, EventsThatComeDuringExposuresOnlyShowThem) {
  SyntheticRecording recording;
  // 3 ms later than the frames' clock has it.
  recording.has_event = [](std::int64_t t) {
    const std::int64_t in_period = t % (40 * kMs);
    return in_period >= 13 * kMs && in_period < 33 * kMs;
  };
  const RecordingSurvey survey = recording.run();
  EXPECT_THAT(namesOf(checkCoverage(survey)), ElementsAre("no-events-between-exposures"));
  const auto seen = exposuresByEvents(survey);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->length_ns, 20.0 * kMs, 0.1 * kMs);
  EXPECT_NEAR(seen->shift_ns, 3.0 * kMs, 0.1 * kMs);
  EXPECT_NEAR(seen->pause_ns, 20.0 * kMs, 0.1 * kMs);
}

TEST(CoverageChecksTest, AHoleAmidManyEventsIsFound) {
  SyntheticRecording recording;
  recording.has_event = [](std::int64_t t) { return t < 200 * kMs || t >= 230 * kMs; };
  const RecordingSurvey survey = recording.run();
  EXPECT_THAT(namesOf(checkCoverage(survey)), ElementsAre("event-holes"));
  const auto holes = eventHoles(survey);
  ASSERT_EQ(holes.size(), 1U);
  EXPECT_NEAR(static_cast<double>(holes[0].length()), 30.0 * kMs, 0.1 * kMs);
}

TEST(CoverageChecksTest, ALullInFewEventsIsNoHole) {
  SyntheticRecording recording;
  recording.has_event = [](std::int64_t t) {
    const bool calm = t >= 100 * kMs && t < 400 * kMs;
    return !calm || t % (5 * kMs) == 0;
  };
  EXPECT_THAT(checkCoverage(recording.run()), IsEmpty());
}

TEST(CoverageChecksTest, ExposuresWithoutEventsAreCounted) {
  SyntheticRecording recording;
  recording.event_stamp = [](std::int64_t t) { return t + 200 * kMs; };
  EXPECT_THAT(namesOf(checkCoverage(recording.run())), ElementsAre("exposures-uncovered"));
  recording.parameters.time_offset_ns = 200 * kMs;
  EXPECT_THAT(checkCoverage(recording.run()), IsEmpty());
}

}  // namespace
}  // namespace fast_edi
