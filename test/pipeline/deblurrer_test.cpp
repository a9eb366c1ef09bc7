#include "fast_edi/pipeline/deblurrer.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/events/event_coverage.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "support/allocation_counter.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/reference_double_integral.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kUs = kNanosecondsPerMicrosecond;
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{6, 4};
/// Sensor time of "0 ms" in the tests.
constexpr std::int64_t kZero = 1000 * kNanosecondsPerSecond;

/// Sensor times and arrival times are both given in milliseconds, on clocks of their own.
class DeblurrerTest : public ::testing::Test {
 protected:
  DeblurrerTest() {
    parameters.thresholds = {0.3, 0.25};
    parameters.exposure_source = ExposureSource::kParameter;
    parameters.exposure_time_ns = 20 * kMs;
    parameters.filter.enabled = false;  // so that the double integral's own pixels can be checked
  }

  Deblurrer& pipeline() {
    if (!pipeline_) {
      pipeline_ = std::make_unique<Deblurrer>(parameters, sink);
    }
    return *pipeline_;
  }

  /// Events of random pixels, ten in each millisecond of [from, to), as one array.
  void events(std::int64_t from_ms, std::int64_t to_ms, std::int64_t now_ms) {
    std::vector<Event> list;
    for (std::int64_t t_ns = from_ms * kMs; t_ns < to_ms * kMs; t_ns += kMs / 10) {
      list.push_back(randomEvent(kZero + t_ns));
    }
    events(list, now_ms);
  }
  void events(const std::vector<Event>& list, std::int64_t now_ms, SensorSize size = kSize) {
    all_events.insert(all_events.end(), list.begin(), list.end());
    pipeline().addEvents(testing::wireView(testing::toWire(list)), size, ++sequence, now_ms * kMs);
  }
  void eventAt(std::int64_t t_ns, std::int64_t now_ms) { events({randomEvent(t_ns)}, now_ms); }

  void frame(std::int64_t stamp_ms, std::int64_t now_ms) {
    pipeline().addFrame(makeFrame(stamp_ms), now_ms * kMs);
  }
  InputFrame makeFrame(std::int64_t stamp_ms) {
    return testing::makeFrame(kZero + stamp_ms * kMs, kSize, testing::makeGreyImage(kSize, 3));
  }
  void exposure(std::int32_t length_us, std::int64_t now_ms) {
    pipeline().addExposure(length_us, now_ms * kMs);
  }
  void advance(std::int64_t now_ms) { pipeline().advance(now_ms * kMs); }

  const std::vector<testing::RecordedFrame>& outputs() const { return sink.outputs; }
  const OutputFrame& output(std::size_t i) const { return sink.outputs.at(i).frame; }
  const DeblurCounters& counters() { return pipeline().counters(); }

  std::vector<std::int64_t> stamps_ms() const {
    std::vector<std::int64_t> stamps;
    for (const auto& recorded : outputs()) {
      stamps.push_back((recorded.frame.stamp_ns - kZero) / kMs);
    }
    return stamps;
  }

  void expectPassed(std::size_t i, PassReason reason) {
    ASSERT_LT(i, outputs().size());
    EXPECT_FALSE(output(i).deblurred);
    EXPECT_EQ(output(i).pass_reason, reason) << toString(output(i).pass_reason);
    EXPECT_EQ(output(i).events, 0u);
    const ImageView& in = output(i).input.image;
    EXPECT_EQ(outputs()[i].pixels,
              std::vector<std::uint8_t>(in.data, in.data + in.size.pixelCount()));
  }

  /// Output i is what the slow reference makes of all the events so far.
  void expectDeblurred(std::size_t i) { expectDeblurred(i, all_events); }
  void expectDeblurred(std::size_t i, const std::vector<Event>& of_events) {
    ASSERT_LT(i, outputs().size());
    ASSERT_TRUE(output(i).deblurred) << toString(output(i).pass_reason);
    const DeblurParameters& p = pipeline().parameters();
    const ExposureInterval window{output(i).exposure.start_ns + p.time_offset_ns,
                                  output(i).exposure.end_ns + p.time_offset_ns};
    const auto integral = testing::referenceDoubleIntegral(
        kSize, of_events, p.thresholds, p.weighting, window, window.at(p.reference));
    const auto inside = std::count_if(of_events.begin(), of_events.end(), [&](const Event& e) {
      return e.t_ns >= window.start_ns && e.t_ns < window.end_ns;
    });
    EXPECT_EQ(output(i).events, static_cast<std::uint64_t>(inside));
    for (std::size_t pixel = 0; pixel < integral.size(); ++pixel) {
      const double expected = std::min(255.0, output(i).input.image.data[pixel] / integral[pixel]);
      EXPECT_NEAR(outputs()[i].pixels[pixel], expected, 1.0) << "output " << i << " px " << pixel;
    }
  }

  Event randomEvent(std::int64_t t_ns) {
    Event event;
    event.x = static_cast<std::uint16_t>(random_() % kSize.width);
    event.y = static_cast<std::uint16_t>(random_() % kSize.height);
    event.on = random_() % 2 == 0;
    event.t_ns = t_ns;
    return event;
  }

  DeblurParameters parameters;
  testing::RecordingSink sink;
  std::vector<Event> all_events;
  std::uint32_t sequence = 0;

 private:
  std::mt19937 random_{42};
  std::unique_ptr<Deblurrer> pipeline_;
};

// --- Closing a frame -----------------------------------------------------------------------------

TEST_F(DeblurrerTest, ClosesWhenTheNewestEventReachesTheEndOfTheExposure) {
  events(0, 30, 0);
  frame(40, 1);  // [30, 50) ms
  eventAt(kZero + 50 * kMs - 1, 2);
  EXPECT_TRUE(outputs().empty());
  eventAt(kZero + 50 * kMs, 3);
  expectDeblurred(0);
  EXPECT_EQ(output(0).stamp_ns, kZero + 40 * kMs);
  EXPECT_EQ(counters().frames_timed_out, 0u);
}

TEST_F(DeblurrerTest, ClosesAtOnceWhenTheEventsAreThereAlready) {
  events(0, 60, 0);
  frame(40, 1);
  expectDeblurred(0);
}

TEST_F(DeblurrerTest, AnEventAtTheStartCountsAndOneAtTheEndDoesNot) {
  eventAt(kZero, 0);
  eventAt(kZero + 30 * kMs - 1, 0);
  eventAt(kZero + 30 * kMs, 0);
  eventAt(kZero + 50 * kMs - 1, 0);
  eventAt(kZero + 50 * kMs, 0);
  frame(40, 1);
  expectDeblurred(0);
  EXPECT_EQ(output(0).events, 2u);
}

TEST_F(DeblurrerTest, ClosesAfterTheTimeoutWithWhatHasCome) {
  events(0, 45, 0);
  frame(40, 1);
  advance(100);
  EXPECT_TRUE(outputs().empty());
  advance(101);
  expectDeblurred(0);
  EXPECT_EQ(counters().frames_timed_out, 1u);
}

TEST_F(DeblurrerTest, ATimeoutStrikesBeforeALaterMessageIsTakenIn) {
  events(0, 45, 0);
  frame(40, 1);
  const std::vector<Event> in_time = all_events;
  events(45, 60, 200);
  expectDeblurred(0, in_time);
  EXPECT_EQ(counters().frames_timed_out, 1u);
}

TEST_F(DeblurrerTest, AStillSceneIsDeblurredUnchanged) {
  events(0, 10, 0);
  frame(40, 1);
  advance(101);
  ASSERT_EQ(outputs().size(), 1u);
  EXPECT_TRUE(output(0).deblurred);
  EXPECT_EQ(outputs()[0].pixels, testing::makeGreyImage(kSize, 3));
  EXPECT_EQ(counters().frames_still, 1u);
  EXPECT_EQ(counters().frames_deblurred, 1u);
}

TEST_F(DeblurrerTest, FramesFarAheadOfEventsThatKeepComingAreNoStillScene) {
  // Frame stamps that run twice as fast as the events.
  for (std::int64_t t = 0; t < 4000; t += 40) {
    events(t, t + 40, t + 45);
    frame(2 * (t + 30), t + 50);
  }
  pipeline().finish();
  EXPECT_EQ(counters().frames_still, 0u);
  const auto differ = counters().frames_passed[static_cast<std::size_t>(PassReason::kClocksDiffer)];
  const auto missing =
      counters().frames_passed[static_cast<std::size_t>(PassReason::kEventsMissing)];
  EXPECT_GT(differ, 60u);
  EXPECT_GT(missing, 10u);  // up to one second apart
  EXPECT_LE(counters().frames_deblurred, 4u);
  EXPECT_EQ(counters().framesPassed(), differ + missing);
  const ClockPair clocks = pipeline().status().differing_clocks;
  EXPECT_GT(clocks.frame_ns - clocks.events_ns, kNanosecondsPerSecond);
  EXPECT_EQ(clocks.frame_ns, kZero + 2 * (3960 + 30) * kMs);
}

TEST_F(DeblurrerTest, AFrameMoreThanASecondAheadNamesTheClocksAndOneNearerMissesEvents) {
  events(0, 10, 0);
  frame(1021, 1);  // begins at 1011 ms, more than 1 s behind the newest event
  eventAt(kZero + 11 * kMs - 1, 2);
  advance(101);
  expectPassed(0, PassReason::kClocksDiffer);
  frame(1022, 102);  // begins at 1012 ms
  eventAt(kZero + 12 * kMs, 103);
  advance(202);
  expectPassed(1, PassReason::kEventsMissing);
}

TEST_F(DeblurrerTest, OnceClocksDifferSilenceIsNoStillScene) {
  events(0, 10, 0);
  frame(2000, 1);
  events(10, 20, 50);
  advance(101);
  expectPassed(0, PassReason::kClocksDiffer);
  frame(2040, 102);
  advance(202);
  expectPassed(1, PassReason::kClocksDiffer);
  events(20, 2120, 203);  // the events come after all
  frame(2080, 204);
  expectDeblurred(2);
  frame(2500, 205);
  advance(305);
  ASSERT_EQ(outputs().size(), 4u);
  EXPECT_TRUE(output(3).deblurred);
  EXPECT_EQ(counters().frames_still, 1u);
}

TEST_F(DeblurrerTest, FramesFarBeforeTheFirstEventNameTheClocks) {
  events(5000, 5100, 0);
  frame(3988, 1);  // ends at 3998 ms; events count as complete from 4999 ms
  expectPassed(0, PassReason::kClocksDiffer);
  EXPECT_EQ(pipeline().status().differing_clocks.frame_ns, kZero + 3988 * kMs);
  frame(3989, 2);
  expectPassed(1, PassReason::kEventsMissing);
}

TEST_F(DeblurrerTest, EventsThatLagBehindTheFramesAreMissingAndNoStillScene) {
  events(0, 10, 0);
  for (std::int64_t t = 0; t < 400; t += 40) {
    frame(t + 500, t);
    events(t + 10, t + 50, t + 20);
  }
  advance(1000);
  ASSERT_EQ(outputs().size(), 10u);
  for (std::size_t i = 0; i < outputs().size(); ++i) {
    expectPassed(i, PassReason::kEventsMissing);
  }
}

TEST_F(DeblurrerTest, WhereTheRecordingEndsBeforeItsLastFrameNoSceneIsStill) {
  events(0, 60, 60);
  frame(100, 110);
  pipeline().finish();
  expectPassed(0, PassReason::kEventsMissing);
}

TEST_F(DeblurrerTest, ASceneThatWasStillForLongEnoughIsStillAtTheEndOfTheRecording) {
  events(0, 60, 60);
  frame(100, 160);
  pipeline().finish();
  ASSERT_EQ(outputs().size(), 1u);
  EXPECT_TRUE(output(0).deblurred);
  EXPECT_EQ(counters().frames_still, 1u);
}

TEST_F(DeblurrerTest, KeepsNoMoreEventsThanTheLongestExposureNeedsWhileItIsUnknown) {
  constexpr std::size_t kEventsOfArray = 20'000;  // of 100 ms
  constexpr std::size_t kMost = 12 * kEventsOfArray + PixelEventLists::kChunkEvents;
  parameters.exposure_time_ns = 0;
  for (std::int64_t end_ms = 100; end_ms <= 4000; end_ms += 100) {
    events(testing::makeEvents(testing::EventScene::kUniform,
                               {kSize, kEventsOfArray, kZero + (end_ms - 100) * kMs, 100 * kMs,
                                static_cast<std::uint64_t>(end_ms)}),
           end_ms);
    frame(end_ms - 50, end_ms);
    EXPECT_LE(pipeline().status().buffered_events, kMost);
  }
  expectPassed(39, PassReason::kExposureUnknown);
  parameters.exposure_time_ns = kMaxExposure_ns;
  pipeline().setParameters(parameters);
  events(4000, 4600, 5000);
  frame(4050, 5001);
  ASSERT_EQ(outputs().size(), 41U);
  EXPECT_TRUE(output(40).deblurred) << toString(output(40).pass_reason);
}

TEST_F(DeblurrerTest, NoSceneIsStillWhileNobodyListensToItsEvents) {
  events(0, 20, 20);
  events(20, 40, 40);
  pipeline().noteMissingArrays();
  frame(20, 41);
  EXPECT_TRUE(output(0).deblurred);
  frame(60, 70);
  // At once: nothing will come that it could wait for.
  ASSERT_EQ(outputs().size(), 2u);
  expectPassed(1, PassReason::kEventsMissing);
  EXPECT_EQ(counters().frames_still, 0u);
  EXPECT_EQ(counters().frames_timed_out, 0u);
  sequence += 5;
  events(100, 150, 200);
  frame(120, 201);
  expectDeblurred(2);
  EXPECT_EQ(counters().event_arrays_missing, 5u);
  frame(160, 202);
  ASSERT_EQ(outputs().size(), 3u);  // waits again
  events(150, 200, 210);
  expectDeblurred(3);
}

TEST_F(DeblurrerTest, AFrameBeforeItsEventsWaitsForThem) {
  frame(40, 0);
  events(0, 60, 50);
  expectDeblurred(0);
}

TEST_F(DeblurrerTest, WithoutAnyEventArrayItIsPassedThroughAfterTheTimeout) {
  frame(40, 0);
  advance(99);
  EXPECT_TRUE(outputs().empty());
  advance(100);
  expectPassed(0, PassReason::kNoEventStream);
}

TEST_F(DeblurrerTest, AnExposureMicrosecondsBeforeTheFirstEventEverIsDeblurred) {
  eventAt(kZero + 30 * kMs + 6 * kUs, 0);
  events(31, 60, 0);
  frame(40, 1);
  expectDeblurred(0);
}

TEST_F(DeblurrerTest, AnExposureThatBeganBeforeTheEventsIsPassedThrough) {
  eventAt(kZero + 30 * kMs + EventCoverage::kStartSlack_ns + 1, 0);
  events(32, 60, 0);
  frame(40, 1);
  expectPassed(0, PassReason::kEventsMissing);
  EXPECT_EQ(output(0).exposure, (ExposureInterval{kZero + 30 * kMs, kZero + 50 * kMs}));
}

TEST_F(DeblurrerTest, FramesThatOverlapALostArrayArePassedThroughAndNoOthers) {
  events(0, 20, 0);
  events(20, 60, 0);
  ++sequence;
  events(70, 200, 0);
  for (std::int64_t stamp_ms : {30, 49, 60, 79, 81, 100}) {
    frame(stamp_ms, 1);
  }
  ASSERT_EQ(outputs().size(), 6u);
  expectDeblurred(0);
  expectDeblurred(1);
  expectPassed(2, PassReason::kEventsMissing);
  expectPassed(3, PassReason::kEventsMissing);
  expectDeblurred(4);
  expectDeblurred(5);
  EXPECT_EQ(counters().event_array_gaps, 1u);
}

TEST_F(DeblurrerTest, AFrameWhoseEventsWerePushedOutIsPassedThrough) {
  parameters.max_buffered_events = PixelEventLists::kChunkEvents;
  const auto flood =
      testing::makeEvents(testing::EventScene::kUniform,
                          {kSize, PixelEventLists::kChunkEvents + 100, kZero, 100 * kMs, 1});
  events(flood, 0);
  frame(40, 1);
  expectPassed(0, PassReason::kEventsMissing);
  EXPECT_GT(counters().events_overflowed, 0u);
}

TEST_F(DeblurrerTest, FramesLeaveInTheOrderOfTheirArrival) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 200, 0);
  frame(40, 1);
  frame(80, 2);
  InputFrame odd = makeFrame(120);
  odd.supported = false;
  pipeline().addFrame(odd, 3 * kMs);
  EXPECT_TRUE(outputs().empty());
  exposure(10'000, 4);
  exposure(10'000, 5);
  exposure(10'000, 6);
  EXPECT_THAT(stamps_ms(), ElementsAre(40, 80, 120));
}

TEST_F(DeblurrerTest, SinkCallsComeInPairs) {
  frame(40, 0);
  events(0, 60, 0);
  frame(80, 1);
  pipeline().finish();
  EXPECT_TRUE(sink.isBalanced());
  EXPECT_EQ(outputs().size(), 2u);
}

// --- Exposure ------------------------------------------------------------------------------------

TEST_F(DeblurrerTest, EachFrameTakesItsOwnMessage) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 200, 0);
  frame(40, 1);
  EXPECT_TRUE(outputs().empty());
  exposure(10'000, 2);
  exposure(30'000, 3);
  frame(80, 4);
  ASSERT_EQ(outputs().size(), 2u);
  EXPECT_EQ(output(0).exposure, (ExposureInterval{kZero + 35 * kMs, kZero + 45 * kMs}));
  EXPECT_EQ(output(1).exposure, (ExposureInterval{kZero + 65 * kMs, kZero + 95 * kMs}));
  expectDeblurred(0);
  expectDeblurred(1);
}

TEST_F(DeblurrerTest, WithoutItsMessageAFrameTakesTheLastOneAfterTheTimeout) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 200, 0);
  frame(40, 1);
  exposure(10'000, 2);
  frame(80, 41);
  advance(140);
  EXPECT_EQ(outputs().size(), 1u);
  advance(141);
  ASSERT_EQ(outputs().size(), 2u);
  EXPECT_EQ(output(1).exposure.length(), 10 * kMs);
  EXPECT_EQ(counters().exposures_missing, 1u);
  expectDeblurred(1);
}

TEST_F(DeblurrerTest, WithoutAnyMessageAFrameTakesTheParameterAndLaterOnesDoNotWait) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 400, 0);
  frame(40, 1);
  advance(101);
  ASSERT_EQ(outputs().size(), 1u);
  EXPECT_EQ(output(0).exposure.length(), 20 * kMs);
  frame(120, 110);
  ASSERT_EQ(outputs().size(), 2u);
  frame(160, 150);
  exposure(5'000, 151);
  EXPECT_EQ(outputs().size(), 3u);
  frame(200, 190);
  EXPECT_EQ(outputs().size(), 3u) << "the topic speaks: frames wait for it again";
  exposure(6'000, 191);
  ASSERT_EQ(outputs().size(), 4u);
  EXPECT_EQ(output(3).exposure.length(), 6 * kMs);
}

TEST_F(DeblurrerTest, WithNeitherTopicNorParameterAFrameIsPassedThroughWithItsOwnStamp) {
  parameters.exposure_source = ExposureSource::kTopic;
  parameters.exposure_time_ns = 0;
  parameters.reference = ExposureInstant::kStart;
  events(0, 200, 0);
  frame(40, 1);
  advance(101);
  expectPassed(0, PassReason::kExposureUnknown);
  EXPECT_EQ(output(0).stamp_ns, kZero + 40 * kMs);
  EXPECT_EQ(output(0).exposure.length(), 0);
  EXPECT_FALSE(pipeline().status().exposure_known);
}

TEST_F(DeblurrerTest, ARefusedMessageLeavesItsFrameWithTheLastValue) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 400, 0);
  frame(40, 1);
  exposure(10'000, 2);
  frame(80, 41);
  exposure(0, 42);
  frame(120, 81);
  exposure(12'000, 82);
  ASSERT_EQ(outputs().size(), 3u);
  EXPECT_EQ(output(1).exposure.length(), 10 * kMs);
  EXPECT_EQ(output(2).exposure.length(), 12 * kMs);
  EXPECT_EQ(counters().exposures_refused, 1u);
}

TEST_F(DeblurrerTest, FramesThatLeaveWithoutWaitingStillCountTheirMessagesOff) {
  parameters.exposure_source = ExposureSource::kTopic;
  parameters.passthrough = true;
  events(0, 400, 0);
  frame(40, 1);
  EXPECT_EQ(outputs().size(), 1u);
  parameters.passthrough = false;
  pipeline().setParameters(parameters);
  frame(80, 2);
  exposure(10'000, 3);
  EXPECT_EQ(outputs().size(), 1u);
  exposure(12'000, 4);
  ASSERT_EQ(outputs().size(), 2u);
  EXPECT_EQ(output(1).exposure.length(), 12 * kMs);
}

TEST_F(DeblurrerTest, ByParameterMessagesAreOnlyTakenNoteOf) {
  events(0, 100, 0);
  exposure(10'000, 0);
  exposure(-1, 0);
  frame(40, 1);
  EXPECT_EQ(output(0).exposure.length(), 20 * kMs);
  EXPECT_EQ(counters().exposures_in, 2u);
  EXPECT_EQ(counters().exposures_refused, 1u);
  advance(1000);
  EXPECT_EQ(counters().exposures_surplus + counters().exposures_missing, 0u);
}

// --- Stamps --------------------------------------------------------------------------------------

TEST_F(DeblurrerTest, TheOutputStampIsTheInstantThatTheLatentImageShows) {
  const std::int64_t half = 10 * kMs;
  for (const auto stamp_reference :
       {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
    for (const auto reference :
         {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
      parameters.stamp_reference = stamp_reference;
      parameters.reference = reference;
      testing::RecordingSink own_sink;
      Deblurrer own(parameters, own_sink);
      own.addFrame(makeFrame(40), 0);
      own.finish();
      ASSERT_EQ(own_sink.outputs.size(), 1u);
      const std::int64_t moved = (static_cast<int>(reference) - static_cast<int>(stamp_reference));
      // Passed through, with the stamp it would have had deblurred.
      EXPECT_FALSE(own_sink.outputs[0].frame.deblurred);
      EXPECT_EQ(own_sink.outputs[0].frame.stamp_ns, kZero + 40 * kMs + moved * half);
    }
  }
}

TEST_F(DeblurrerTest, DeblurredAtStartMiddleAndEnd) {
  events(0, 60, 0);
  for (const auto reference :
       {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
    parameters.reference = reference;
    pipeline().setParameters(parameters);
    frame(30 + static_cast<int>(reference), 1);
    expectDeblurred(outputs().size() - 1);
  }
}

TEST_F(DeblurrerTest, AnOddExposureKeepsTheInputStampAtTheMiddle) {
  parameters.exposure_time_ns = 20'001 * kUs;
  events(0, 60, 0);
  frame(40, 1);
  EXPECT_EQ(output(0).stamp_ns, kZero + 40 * kMs);
  expectDeblurred(0);
}

TEST_F(DeblurrerTest, AStampThatIsNotLaterGivesNoOutputAndIsCounted) {
  events(0, 200, 0);
  frame(80, 1);
  frame(80, 2);
  frame(79, 3);
  frame(81, 4);
  EXPECT_THAT(stamps_ms(), ElementsAre(80, 81));
  EXPECT_EQ(counters().frames_suppressed, 2u);
  EXPECT_EQ(counters().frames_in, 4u);
}

TEST_F(DeblurrerTest, TheTimeOffsetShiftsEventsAndLeavesStampsAlone) {
  parameters.time_offset_ns = -7 * kMs;
  events(0, 43, 0);
  frame(40, 1);
  EXPECT_TRUE(outputs().empty());
  eventAt(kZero + 43 * kMs, 2);  // the exposure ends at 50 ms in frame time
  EXPECT_THAT(stamps_ms(), ElementsAre(40));
  EXPECT_EQ(output(0).exposure, (ExposureInterval{kZero + 30 * kMs, kZero + 50 * kMs}));
  expectDeblurred(0);
}

// --- Faults --------------------------------------------------------------------------------------

TEST_F(DeblurrerTest, AJumpBackOfTheEventsClosesWaitingFramesAndBeginsANewEpoch) {
  events(10'000, 10'045, 0);
  frame(10'040, 1);
  const std::vector<Event> before = all_events;
  all_events.clear();
  events(0, 60, 2);
  expectDeblurred(0, before);
  frame(40, 3);
  expectDeblurred(1);
  EXPECT_THAT(stamps_ms(), ElementsAre(10'040, 40));
  EXPECT_EQ(counters().event_time_jumps, 1u);
  EXPECT_EQ(counters().frame_time_jumps, 1u);
  EXPECT_EQ(counters().frames_suppressed, 0u);
}

TEST_F(DeblurrerTest, AJumpBackOfTheFramesWaitsForThatOfTheEvents) {
  events(10'000, 10'100, 0);
  frame(10'040, 1);
  frame(10'080, 2);
  EXPECT_EQ(outputs().size(), 2u);
  frame(40, 3);
  EXPECT_EQ(outputs().size(), 2u);
  all_events.clear();
  events(0, 60, 4);
  expectDeblurred(2);
  EXPECT_THAT(stamps_ms(), ElementsAre(10'040, 10'080, 40));
}

TEST_F(DeblurrerTest, AFrameStillWaitingWhenTheFramesJumpBackIsClosedByTheJumpOfTheEvents) {
  events(10'000, 10'045, 0);
  frame(10'040, 1);
  frame(40, 2);
  events(10'045, 10'060, 3);  // its events come after all
  expectDeblurred(0);
  EXPECT_EQ(outputs().size(), 1u);
  all_events.clear();
  events(0, 60, 4);
  expectDeblurred(1);
}

TEST_F(DeblurrerTest, AJumpBackOfTheFramesAloneIsPassedThroughAfterTheTimeout) {
  events(10'000, 10'100, 0);
  frame(10'080, 1);
  frame(40, 2);
  advance(101);
  EXPECT_EQ(outputs().size(), 1u);
  advance(102);
  expectPassed(1, PassReason::kClocksDiffer);
  EXPECT_EQ(counters().frame_time_jumps, 1u);
}

TEST_F(DeblurrerTest, AFrameOfTheNewEpochBeforeItsEventsIsNotClosedByTheirJump) {
  events(0, 30, 0);
  frame(100'040, 1);  // the frames' clock is ahead already
  events(100'000, 100'030, 2);
  events(100'030, 100'045, 3);  // confirms
  EXPECT_TRUE(outputs().empty());
  events(100'045, 100'060, 4);
  expectDeblurred(0);
  EXPECT_EQ(counters().event_time_jumps, 1u);
}

TEST_F(DeblurrerTest, AnUnconfirmedJumpAheadNeitherClosesFramesNorEntersTheLists) {
  events(0, 30, 0);
  frame(15, 0);
  EXPECT_EQ(outputs().size(), 1u);
  frame(40, 1);
  const std::vector<Event> real = all_events;
  eventAt(kZero + 100'000 * kMs, 2);
  EXPECT_EQ(outputs().size(), 1u);
  all_events = real;
  events(30, 60, 3);
  expectDeblurred(1);
  EXPECT_EQ(counters().event_time_jumps, 0u);
  EXPECT_EQ(counters().events_glitched, 1u);
}

TEST_F(DeblurrerTest, ASingleLateEventIsDroppedAndCounted) {
  events(0, 40, 0);
  const std::vector<Event> real = all_events;
  eventAt(kZero + 20 * kMs, 1);
  all_events = real;
  events(40, 60, 2);
  frame(40, 3);
  expectDeblurred(0);
  EXPECT_EQ(counters().events_late, 1u);
}

TEST_F(DeblurrerTest, ARecordingPlayedThreeTimesIsDeblurredThreeTimes) {
  for (int round = 0; round < 3; ++round) {
    const std::int64_t now = 1200 * round;
    all_events.clear();
    for (std::int64_t t = 0; t < 1000; t += 40) {
      events(t, t + 40, now + t + 40);
      if (t > 0) {
        frame(t, now + t + 40);
        expectDeblurred(outputs().size() - 1);
      }
    }
  }
  EXPECT_EQ(outputs().size(), 3u * 24u);
  EXPECT_EQ(counters().frames_deblurred, 3u * 24u);
  EXPECT_EQ(counters().event_time_jumps, 2u);
  EXPECT_EQ(counters().frame_time_jumps, 2u);
}

TEST_F(DeblurrerTest, AtASizeChangeCompleteFramesAreDeblurredAndOverlappingOnesPassedThrough) {
  events(0, 45, 0);
  frame(40, 1);  // ends before the first event of the other size
  frame(60, 1);  // does not
  const std::vector<Event> before = all_events;
  events({randomEvent(kZero + 55 * kMs)}, 2, {8, 8});
  expectDeblurred(0, before);
  EXPECT_EQ(outputs().size(), 1u);
  events({randomEvent(kZero + 80 * kMs)}, 3, {8, 8});
  ASSERT_EQ(outputs().size(), 2u);
  EXPECT_FALSE(output(1).deblurred);
  EXPECT_EQ(counters().size_changes, 1u);
  EXPECT_EQ(pipeline().status().sensor_size, (SensorSize{8, 8}));
}

TEST_F(DeblurrerTest, AFrameOfAnotherSizeIsPassedThroughAndTheNextOnesAreDeblurred) {
  events(0, 200, 0);
  frame(40, 1);
  pipeline().addFrame(testing::makeFlatFrame(kZero + 80 * kMs, {6, 5}), kMs);
  frame(120, 2);
  expectDeblurred(0);
  expectPassed(1, PassReason::kSizeMismatch);
  expectDeblurred(2);
}

TEST_F(DeblurrerTest, FramesOfAnotherSizeInTheQueueDoNotDisturbTheOnesBefore) {
  events(0, 30, 0);
  frame(40, 1);
  pipeline().addFrame(testing::makeFlatFrame(kZero + 60 * kMs, {6, 5}), kMs);
  events(30, 100, 2);
  expectDeblurred(0);
  expectPassed(1, PassReason::kSizeMismatch);
}

TEST_F(DeblurrerTest, AnUnsupportedFrameMayHaveNoPixels) {
  events(0, 60, 0);
  InputFrame frame;
  frame.stamp_ns = kZero + 40 * kMs;
  frame.supported = false;
  pipeline().addFrame(frame, kMs);
  ASSERT_EQ(outputs().size(), 1u);
  EXPECT_EQ(output(0).pass_reason, PassReason::kUnsupportedEncoding);
  EXPECT_TRUE(outputs()[0].pixels.empty());
}

TEST_F(DeblurrerTest, AnEventArrayOfNonsensicalSizeTakesNoMemory) {
  events({randomEvent(kZero)}, 0, {32767, 32767});
  frame(40, 0);
  events({randomEvent(kZero + 60 * kMs)}, 0, {32767, 32767});
  expectPassed(0, PassReason::kSizeMismatch);
  EXPECT_LT(pipeline().status().buffer_bytes, std::size_t{2} << 20);
}

TEST_F(DeblurrerTest, AnEventArrayWithoutSizeIsRefusedAndItsTimeIsNotCovered) {
  events(0, 35, 0);
  events({randomEvent(kZero + 36 * kMs)}, 0, {0, 0});
  events(37, 60, 0);
  frame(40, 1);
  expectPassed(0, PassReason::kEventsMissing);
  EXPECT_EQ(counters().event_arrays_refused, 1u);
}

TEST_F(DeblurrerTest, FramesWithoutEndAreBoundedByPassingTheOldestThrough) {
  events(0, 10, 0);
  for (int i = 0; i < 1000; ++i) {
    frame(100 + i, 1);  // the clock stands still: no timeout helps
    EXPECT_LE(pipeline().status().waiting_frames, 100u);
  }
  EXPECT_EQ(outputs().size(), 900u);
  expectPassed(0, PassReason::kTooManyWaiting);
  EXPECT_EQ(counters().frames_passed[static_cast<std::size_t>(PassReason::kEventsMissing)], 0u);
}

TEST_F(DeblurrerTest, AFrameThatHasToGoIsDeblurredIfNothingButItsExposureIsMissing) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 1000, 0);
  frame(40, 1);
  exposure(20'000, 1);
  for (int i = 0; i < 101; ++i) {
    frame(80 + i, 2);  // their exposures are late
  }
  ASSERT_EQ(outputs().size(), 2u);
  EXPECT_TRUE(output(1).deblurred) << toString(output(1).pass_reason);
  EXPECT_EQ(output(1).exposure.length(), 20 * kMs);
}

TEST_F(DeblurrerTest, AStampFarAheadDoesNotThrowTheEventsAway) {
  events(0, 60, 0);
  frame(100'000'000, 1);
  advance(101);
  EXPECT_EQ(outputs().size(), 1u);
  frame(40, 102);
  expectDeblurred(1);
}

// --- Parameters and life cycle -------------------------------------------------------------------

TEST_F(DeblurrerTest, RefusesParametersOutOfRange) {
  parameters.thresholds.on = 0.0;
  EXPECT_THROW(Deblurrer(parameters, sink), std::invalid_argument);
}

TEST_F(DeblurrerTest, AnInvalidChangeKeepsTheOldParameters) {
  events(0, 60, 0);
  DeblurParameters bad = parameters;
  bad.thresholds.off = 0.9;
  bad.close_timeout_ns = -1;
  EXPECT_THROW(pipeline().setParameters(bad), std::invalid_argument);
  EXPECT_EQ(pipeline().parameters().thresholds, parameters.thresholds);
  frame(40, 1);
  expectDeblurred(0);
}

TEST_F(DeblurrerTest, NewThresholdsAndWeightingHoldForFramesClosedFromThenOn) {
  events(0, 30, 0);
  frame(40, 1);
  parameters.thresholds = {0.5, 0.45};
  pipeline().setParameters(parameters);
  events(30, 60, 2);
  expectDeblurred(0);
  parameters.weighting = Weighting::kCounter;
  pipeline().setParameters(parameters);
  frame(45, 3);
  expectDeblurred(1);
}

TEST_F(DeblurrerTest, ANewExposureTimeHoldsForWaitingFramesToo) {
  events(0, 30, 0);
  frame(40, 1);
  parameters.exposure_time_ns = 8 * kMs;
  pipeline().setParameters(parameters);
  events(30, 60, 2);
  EXPECT_EQ(output(0).exposure.length(), 8 * kMs);
  expectDeblurred(0);
}

TEST_F(DeblurrerTest, ChangingTheExposureSourceEndsTheWaitForMessages) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 60, 0);
  frame(40, 1);
  EXPECT_TRUE(outputs().empty());
  parameters.exposure_source = ExposureSource::kParameter;
  pipeline().setParameters(parameters);
  advance(2);
  expectDeblurred(0);
}

TEST_F(DeblurrerTest, PassthroughPublishesAtOnceAndUnchanged) {
  parameters.exposure_source = ExposureSource::kTopic;
  parameters.passthrough = true;
  parameters.reference = ExposureInstant::kEnd;
  frame(40, 0);
  expectPassed(0, PassReason::kPassthroughParameter);
  EXPECT_EQ(output(0).stamp_ns, kZero + 40 * kMs);
}

TEST_F(DeblurrerTest, FinishClosesAllWaitingFramesWithWhatHasCome) {
  parameters.exposure_source = ExposureSource::kTopic;
  events(0, 45, 0);
  frame(40, 1);
  exposure(20'000, 1);
  frame(80, 2);
  pipeline().finish();
  ASSERT_EQ(outputs().size(), 2u);
  expectDeblurred(0);
  expectPassed(1, PassReason::kEventsMissing);  // none of its events were recorded
  EXPECT_EQ(output(1).exposure.length(), 20 * kMs);
  EXPECT_EQ(pipeline().status().waiting_frames, 0u);
}

TEST_F(DeblurrerTest, PauseForgetsEventsAndFramesAndStartsUpAnew) {
  events(10'000, 10'045, 0);
  frame(10'040, 1);
  pipeline().pause();
  EXPECT_TRUE(outputs().empty());
  EXPECT_EQ(counters().frames_abandoned, 1u);
  EXPECT_EQ(counters().frames_suppressed, 0u) << "nothing was wrong with its stamp";
  EXPECT_EQ(pipeline().status().buffered_events, 0u);
  EXPECT_FALSE(pipeline().status().events_seen);
  all_events.clear();
  events(0, 60, 5000);
  frame(40, 5001);
  expectDeblurred(0);
  EXPECT_EQ(counters().event_time_jumps + counters().frame_time_jumps, 0u);
}

TEST_F(DeblurrerTest, PeriodicExposuresAreFollowedWhileTheirEventsCome) {
  for (std::int64_t t = 0; t < 1000; t += 10) {
    events(t, t + 10, t + 10);
    if (t % 40 == 0 && t > 0) {
      frame(t - 12, t + 10);
    }
  }
  EXPECT_EQ(counters().frames_deblurred, 24u);
  EXPECT_LE(counters().windows_not_predicted, 2u);
  EXPECT_EQ(counters().windows_predicted + counters().windows_not_predicted, 24u);
  for (std::size_t i = 0; i < outputs().size(); ++i) {
    expectDeblurred(i);
  }
}

TEST_F(DeblurrerTest, WhatNoComingFrameCanAskForIsDropped) {
  // 20 events in each microsecond, so that a frame period takes many chunks.
  constexpr std::size_t kPerPeriod = 800'000;
  std::size_t most = 0;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t from = kZero + i * 40 * kMs;
    const auto list =
        testing::makeEvents(testing::EventScene::kUniform,
                            {kSize, kPerPeriod, from, 40 * kMs, static_cast<std::uint64_t>(i + 1)});
    pipeline().addEvents(testing::wireView(testing::toWire(list)), kSize, ++sequence, i * 40 * kMs);
    frame(i * 40 + 20, i * 40);
    most = std::max(most, pipeline().status().buffered_events);
  }
  EXPECT_LT(most, 2 * kPerPeriod);
  EXPECT_EQ(counters().events_overflowed, 0u);
}

TEST_F(DeblurrerTest, TakingEventsInAllocatesNothingInSteadyState) {
  const auto play = [&](std::int64_t from, std::int64_t to) {
    std::uint64_t allocations = 0;
    for (std::int64_t t = from; t < to; t += 10) {
      std::vector<Event> list;
      for (std::int64_t t_ns = t * kMs; t_ns < (t + 10) * kMs; t_ns += kUs) {
        list.push_back(randomEvent(kZero + t_ns));
      }
      const auto bytes = testing::toWire(list);
      const std::uint64_t before = testing::allocationCount();
      pipeline().addEvents(testing::wireView(bytes), kSize, ++sequence, t * kMs);
      allocations += testing::allocationCount() - before;
      if (t % 40 == 0) {
        frame(t - 12, t);  // closed here, since its events have come
      }
    }
    return allocations;
  };
  play(40, 600);
  EXPECT_EQ(play(600, 1200), 0u);
}

TEST_F(DeblurrerTest, StatusTellsTheStateOfTheMoment) {
  EXPECT_EQ(pipeline().status().sensor_size, (SensorSize{0, 0}));
  EXPECT_FALSE(pipeline().status().events_seen);
  frame(40, 0);
  EXPECT_EQ(pipeline().status().sensor_size, kSize);
  EXPECT_EQ(pipeline().status().waiting_frames, 1u);
  events(0, 45, 1);
  const DeblurStatus status = pipeline().status();
  EXPECT_EQ(status.buffered_events, 450u);
  EXPECT_GT(status.buffer_bytes, 450u * sizeof(PackedEvent));
  EXPECT_TRUE(status.events_seen);
  EXPECT_TRUE(status.exposure_known);
  EXPECT_EQ(status.last_exposure_ns, 20 * kMs);
}

TEST(PassReason, EachHasItsOwnPhrase) {
  std::vector<std::string> phrases;
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    phrases.emplace_back(toString(static_cast<PassReason>(i)));
  }
  std::sort(phrases.begin(), phrases.end());
  EXPECT_EQ(std::adjacent_find(phrases.begin(), phrases.end()), phrases.end());
  EXPECT_THAT(phrases, ::testing::Not(::testing::Contains("unknown reason")));
}

}  // namespace
}  // namespace fast_edi
