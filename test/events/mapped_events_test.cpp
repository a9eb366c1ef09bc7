/// Recordings whose events lie turned against the frames, or have the other polarity: with the
/// parameters that say so, the pipeline gives what it gives for one that is right.
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kFrame{22, 16};

DeblurParameters parametersFor(const EventMapping& mapping) {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.25};
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = 20 * kMs;
  parameters.event_mapping = mapping;
  return parameters;
}

/// The size that the event arrays of a recording state, before \p orientation maps them.
SensorSize recordedSize(EventOrientation orientation) {
  return EventMapping{EventPolarity::kNormal, orientation}.apply(kFrame);
}

/// The other way round: what a recording holds whose events \p mapping brings to the frame.
std::vector<Event> turnedBack(std::vector<Event> events, const EventMapping& mapping) {
  EventMapping inverse = mapping;
  if (mapping.orientation == EventOrientation::kRotate90) {
    inverse.orientation = EventOrientation::kRotate270;
  } else if (mapping.orientation == EventOrientation::kRotate270) {
    inverse.orientation = EventOrientation::kRotate90;
  }
  for (Event& event : events) {
    event = inverse.apply(event, kFrame);
  }
  return events;
}

void play(Deblurrer& deblurrer, const EventMapping& recorded, int first_frame, int frames) {
  for (int i = first_frame; i < first_frame + frames; ++i) {
    const std::int64_t start_ns = kNanosecondsPerSecond + i * 40 * kMs;
    deblurrer.addFrame(
        testing::makeFrame(start_ns + 15 * kMs, kFrame, testing::makeGreyImage(kFrame, 5)),
        start_ns);
    const auto events =
        testing::makeEvents(testing::EventScene::kMovingEdges,
                            {kFrame, 4000, start_ns, 40 * kMs, static_cast<std::uint64_t>(i) + 1});
    deblurrer.addEvents(testing::wireView(testing::toWire(turnedBack(events, recorded))),
                        recordedSize(recorded.orientation), static_cast<std::uint32_t>(i) + 1,
                        start_ns + 40 * kMs);
  }
}

std::vector<testing::RecordedFrame> outputsOf(const EventMapping& recorded) {
  testing::RecordingSink sink;
  Deblurrer deblurrer(parametersFor(recorded), sink);
  play(deblurrer, recorded, 0, 4);
  deblurrer.finish();
  EXPECT_EQ(deblurrer.counters().events_outside, 0u);
  return sink.outputs;
}

TEST(MappedEvents, GiveTheImagesOfARecordingThatIsRight) {
  const std::vector<testing::RecordedFrame> right = outputsOf({});
  ASSERT_EQ(right.size(), 4u);
  ASSERT_TRUE(right.back().frame.deblurred);
  for (const EventPolarity polarity : {EventPolarity::kNormal, EventPolarity::kInverted}) {
    for (const auto& [word, orientation] : kEventOrientations) {
      SCOPED_TRACE(word);
      const std::vector<testing::RecordedFrame> outputs = outputsOf({polarity, orientation});
      ASSERT_EQ(outputs.size(), right.size());
      for (std::size_t i = 0; i < right.size(); ++i) {
        EXPECT_EQ(outputs[i].frame.deblurred, right[i].frame.deblurred);
        EXPECT_TRUE(outputs[i].pixels == right[i].pixels) << "frame " << i;
      }
    }
  }
}

/// Without the parameter, a turned sensor has not the frame's size.
TEST(MappedEvents, OfATransposedSensorDoNotFitTheFrameUnlessMapped) {
  testing::RecordingSink sink;
  Deblurrer deblurrer(parametersFor({}), sink);
  play(deblurrer, {EventPolarity::kNormal, EventOrientation::kTranspose}, 0, 3);
  deblurrer.finish();
  EXPECT_EQ(deblurrer.counters().frames_deblurred, 0u);
}

TEST(MappedEvents, AChangeWhileFramesAreDeblurredShowsInTheFramesAfterIt) {
  const EventMapping recorded{EventPolarity::kInverted, EventOrientation::kRotate90};
  testing::RecordingSink sink;
  Deblurrer deblurrer(parametersFor({}), sink);
  play(deblurrer, recorded, 0, 3);
  EXPECT_EQ(deblurrer.counters().frames_deblurred, 0u);
  deblurrer.setParameters(parametersFor(recorded));
  play(deblurrer, recorded, 3, 4);
  deblurrer.finish();

  testing::RecordingSink fresh_sink;
  Deblurrer fresh(parametersFor(recorded), fresh_sink);
  play(fresh, recorded, 3, 4);
  fresh.finish();
  ASSERT_EQ(sink.outputs.size(), 7u);
  ASSERT_EQ(fresh_sink.outputs.size(), 4u);
  EXPECT_TRUE(sink.outputs.back().frame.deblurred);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(sink.outputs[3 + i].pixels == fresh_sink.outputs[i].pixels) << "frame " << i;
  }
}

}  // namespace
}  // namespace fast_edi
