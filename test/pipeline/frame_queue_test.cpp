// The queue by itself: no integral, no calibration. See deblurrer_test for what comes out at last.
#include "pipeline/frame_queue.hpp"

#include <vector>

#include <gmock/gmock.h>

#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{6, 4};
constexpr std::int64_t kZero = 1000 * kNanosecondsPerSecond;

/// Times in milliseconds. Exposures of 20 ms around the stamp.
class FrameQueueTest : public ::testing::Test {
 protected:
  FrameQueueTest() {
    parameters.exposure_source = ExposureSource::kParameter;
    parameters.exposure_time_ns = 20 * kMs;
  }

  void eventAt(std::int64_t t_ms) {
    queue.noteEvents();
    events.take(testing::wireView(testing::toWire({{1, 1, kZero + t_ms * kMs, true}})), kSize, {});
  }
  void frame(std::int64_t stamp_ms) {
    queue.addFrame(testing::makeFlatFrame(kZero + stamp_ms * kMs, kSize));
  }
  static std::int64_t stamp_ms(const std::optional<ClosedFrame>& frame) {
    return frame ? (frame->output.stamp_ns - kZero) / kMs : -1;
  }

  DeblurParameters parameters;
  DeblurCounters counters;
  EventStream events{{}, counters, [](StreamReset, std::int64_t) {}};
  FrameQueue queue{parameters, events, counters};
};

TEST_F(FrameQueueTest, AFrameIsReadyOnceAnEventReachesTheEndOfItsExposure) {
  queue.advance(0);
  eventAt(0);
  frame(40);
  eventAt(49);
  EXPECT_FALSE(queue.takeReady());
  eventAt(50);
  const std::optional<ClosedFrame> closed = queue.takeReady();
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->verdict.state, FrameState::kReady);
  EXPECT_EQ(closed->window, (ExposureInterval{kZero + 30 * kMs, kZero + 50 * kMs}));
  EXPECT_EQ(queue.size(), 0u);
  EXPECT_FALSE(queue.takeReady());
}

TEST_F(FrameQueueTest, TheWindowIsShiftedByTheTimeOffsetTheExposureIsNot) {
  parameters.time_offset_ns = 3 * kMs;
  queue.advance(0);
  eventAt(0);
  frame(40);
  eventAt(60);
  const std::optional<ClosedFrame> closed = queue.takeReady();
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->output.exposure.start_ns, kZero + 30 * kMs);
  EXPECT_EQ(closed->window.start_ns, kZero + 33 * kMs);
}

TEST_F(FrameQueueTest, LeavesAfterTheTimeoutWithWhatHasCome) {
  queue.advance(0);
  eventAt(0);
  frame(40);
  queue.advance(99 * kMs);
  EXPECT_FALSE(queue.takeReady());
  queue.advance(100 * kMs);
  EXPECT_TRUE(queue.takeReady());
  EXPECT_EQ(counters.frames_timed_out, 1u);
}

TEST_F(FrameQueueTest, FramesOfWhichNoOutputMayComeAreSkippedNotReturned) {
  queue.advance(0);
  eventAt(0);
  for (const std::int64_t stamp : {40, 40, 30, 45}) {
    frame(stamp);
  }
  eventAt(100);
  EXPECT_EQ(stamp_ms(queue.takeReady()), 40);
  EXPECT_EQ(stamp_ms(queue.takeReady()), 45);
  EXPECT_FALSE(queue.takeReady());
  EXPECT_EQ(counters.frames_suppressed, 2u);
}

TEST_F(FrameQueueTest, AJumpBackBeginsAnEpochWhoseStampsStartAnew) {
  queue.advance(0);
  frame(5000);
  frame(40);
  const std::optional<ClosedFrame> first = queue.takeNext();
  const std::optional<ClosedFrame> second = queue.takeNext();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(second->epoch, first->epoch + 1);
  EXPECT_EQ(stamp_ms(second), 40);
  EXPECT_EQ(counters.frame_time_jumps, 1u);
}

TEST_F(FrameQueueTest, OnlyTheFramesBeyondTheLimitAreSurplus) {
  queue.advance(0);
  eventAt(0);
  for (std::size_t i = 0; i <= FrameQueue::kMaxFrames; ++i) {
    EXPECT_FALSE(queue.takeSurplus());
    frame(40 * static_cast<std::int64_t>(i + 1));
  }
  const std::optional<ClosedFrame> surplus = queue.takeSurplus();
  EXPECT_EQ(stamp_ms(surplus), 40);
  EXPECT_EQ(surplus->verdict.reason, PassReason::kTooManyWaiting);
  EXPECT_FALSE(queue.takeSurplus());
  EXPECT_EQ(queue.size(), FrameQueue::kMaxFrames);
}

TEST_F(FrameQueueTest, AtAJumpOfEventsThoseFramesLeaveThatLieNearerToTheOldEpoch) {
  queue.advance(0);
  eventAt(0);
  frame(40);   // to 50
  frame(940);  // to 950
  EXPECT_EQ(stamp_ms(queue.takeBefore(kZero, kZero + 1000 * kMs)), 40);
  EXPECT_FALSE(queue.takeBefore(kZero, kZero + 1000 * kMs));
  EXPECT_EQ(queue.size(), 1u);
}

TEST_F(FrameQueueTest, WaitsForItsOwnExposureMessage) {
  parameters.exposure_source = ExposureSource::kTopic;
  queue.advance(0);
  eventAt(0);
  frame(40);
  eventAt(100);
  EXPECT_FALSE(queue.takeReady());
  queue.addExposure(8000);
  const std::optional<ClosedFrame> closed = queue.takeReady();
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->output.exposure.length(), 8 * kMs);
  EXPECT_EQ(queue.lastExposure(), 8 * kMs);
}

TEST_F(FrameQueueTest, AnotherExposureSourceEndsTheWaitForMessages) {
  parameters.exposure_source = ExposureSource::kTopic;
  queue.advance(0);
  eventAt(0);
  frame(40);
  eventAt(100);
  EXPECT_FALSE(queue.takeReady());
  parameters.exposure_source = ExposureSource::kParameter;
  queue.parametersChanged(true);
  const std::optional<ClosedFrame> closed = queue.takeReady();
  ASSERT_TRUE(closed);
  EXPECT_EQ(closed->output.exposure.length(), 20 * kMs);
}

TEST_F(FrameQueueTest, TheNextExposureIsThatOfTheFirstFrameElseThePredictedOne) {
  EXPECT_FALSE(queue.nextExposure());
  queue.advance(0);
  eventAt(0);
  for (const std::int64_t stamp : {40, 80}) {
    frame(stamp);
    EXPECT_EQ(queue.nextExposure()->start_ns, kZero + 30 * kMs);
  }
  eventAt(100);
  EXPECT_TRUE(queue.takeReady());
  EXPECT_TRUE(queue.takeReady());
  ASSERT_TRUE(queue.nextExposure());
  EXPECT_EQ(*queue.nextExposure(), (ExposureInterval{kZero + 110 * kMs, kZero + 130 * kMs}));
}

TEST_F(FrameQueueTest, RestartAbandonsTheFrames) {
  queue.advance(0);
  frame(40);
  frame(80);
  queue.restart();
  EXPECT_EQ(queue.size(), 0u);
  EXPECT_EQ(counters.frames_abandoned, 2u);
  EXPECT_FALSE(queue.takeNext());
  EXPECT_FALSE(queue.nextExposure());
}

}  // namespace
}  // namespace fast_edi
