// Events turned against the frames: the one parameter that undoes it.
#include "validation/mapping_checks.hpp"

#include <gmock/gmock.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::namesOf;

TEST(MappingChecksTest, TwoMappingsAreOne) {
  constexpr SensorSize kSize{7, 4};
  const Event event{5, 1, 0, true};
  for (const auto& [first_word, first] : kEventOrientations) {
    for (const auto& [second_word, second] : kEventOrientations) {
      const EventMapping a{EventPolarity::kInverted, first};
      const EventMapping b{EventPolarity::kNormal, second};
      const EventMapping both = combined(a, b);
      EXPECT_EQ(both.polarity, EventPolarity::kInverted);
      EXPECT_EQ(both.apply(kSize), b.apply(a.apply(kSize))) << first_word << " " << second_word;
      const Event expected = b.apply(a.apply(event, kSize), a.apply(kSize));
      EXPECT_EQ(both.apply(event, kSize).x, expected.x) << first_word << " " << second_word;
      EXPECT_EQ(both.apply(event, kSize).y, expected.y) << first_word << " " << second_word;
    }
  }
}

TEST(MappingChecksTest, WhatFitsIsNamedTogetherWithWhatIsSetAlready) {
  const RecordingSurvey survey = testing::SyntheticRecording{}.run();
  EXPECT_THAT(checkMapping(survey, {}, {}), IsEmpty());
  TimingEstimate estimate;
  estimate.mapping = {EventPolarity::kInverted, EventOrientation::kFlipY};
  const auto findings =
      checkMapping(survey, estimate, {EventPolarity::kInverted, EventOrientation::kFlipX});
  ASSERT_THAT(namesOf(findings), ElementsAre("orientation", "polarity-inverted"));
  EXPECT_EQ(findings[0].set, "event_orientation: rotate_180");
  EXPECT_EQ(findings[1].set, "event_polarity: normal");
}

TEST(MappingChecksTest, AxesExchangedInArraysOfTheFramesSizeHaveToBeConverted) {
  testing::SyntheticRecording recording;
  recording.change_frame = [](int, FrameMessage& frame) { frame.size = {16, 12}; };
  TimingEstimate estimate;
  estimate.mapping.orientation = EventOrientation::kTranspose;
  EXPECT_THAT(checkMapping(recording.run(), estimate, {})[0].set,
              HasSubstr("x and y of the events exchanged"));
}

}  // namespace
}  // namespace fast_edi
