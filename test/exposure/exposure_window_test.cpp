#include "fast_edi/exposure/exposure_window.hpp"

#include <gtest/gtest.h>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kUs = kNanosecondsPerMicrosecond;
constexpr SensorSize kSize{4, 3};
constexpr std::int64_t kStamp = 1000 * kNanosecondsPerSecond;
constexpr std::int64_t kLength = 20 * kMs;

TEST(ExposureInterval, StampMeansStartMiddleOrEnd) {
  EXPECT_EQ(exposureInterval(kStamp, kLength, ExposureInstant::kStart),
            (ExposureInterval{kStamp, kStamp + kLength}));
  EXPECT_EQ(exposureInterval(kStamp, kLength, ExposureInstant::kMid),
            (ExposureInterval{kStamp - kLength / 2, kStamp + kLength / 2}));
  EXPECT_EQ(exposureInterval(kStamp, kLength, ExposureInstant::kEnd),
            (ExposureInterval{kStamp - kLength, kStamp}));
}

TEST(ExposureInterval, HalfOfAnOddLengthIsRoundedDownToWholeMicrosecondsLikeTheDriver) {
  const ExposureInterval odd = exposureInterval(kStamp, 3001 * kUs, ExposureInstant::kMid);
  EXPECT_EQ(odd.start_ns, kStamp - 1500 * kUs);
  EXPECT_EQ(odd.end_ns, kStamp + 1501 * kUs);
}

TEST(ExposureInterval, TheStampComesBackAtTheInstantItMeans) {
  for (const auto instant :
       {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
    for (const std::int64_t length_us : {1, 2, 3, 9999, 10000, 1'000'000}) {
      EXPECT_EQ(exposureInterval(kStamp, length_us * kUs, instant).at(instant), kStamp);
    }
  }
}

class ExposureWindowTest : public ::testing::Test {
 protected:
  ExposureWindowTest() {
    parameters.thresholds = {0.3, 0.3};
    window.settle(kLength);
  }

  void takeEvents(std::initializer_list<std::int64_t> times_ns, SensorSize size = kSize) {
    std::vector<Event> list;
    for (const std::int64_t t_ns : times_ns) {
      list.push_back({0, 0, t_ns, true});
    }
    events.take(testing::wireView(testing::toWire(list)), size, 0);
  }
  FrameState state(bool out_of_time = false) const {
    return window.judge(traits, events, parameters, out_of_time).state;
  }
  PassReason reason(bool out_of_time = false) const {
    const FrameVerdict verdict = window.judge(traits, events, parameters, out_of_time);
    EXPECT_EQ(verdict.state, FrameState::kPassThrough);
    return verdict.reason;
  }

  DeblurParameters parameters;
  DeblurCounters counters;
  EventStream events{PixelEventLists::Limits{}, counters, [](auto, auto) {}};
  FrameTraits traits{true, kSize, false};
  ExposureWindow window{kStamp, true};
  const std::int64_t start = kStamp - kLength / 2;
  const std::int64_t end = kStamp + kLength / 2;
};

TEST_F(ExposureWindowTest, WaitsForItsMessageFirst) {
  const ExposureWindow fresh(kStamp, true);
  EXPECT_TRUE(fresh.awaitsMessage());
  EXPECT_EQ(fresh.length(parameters), 0);
  takeEvents({start, end});
  EXPECT_EQ(fresh.judge(traits, events, parameters, false).state, FrameState::kWaitingForExposure);
}

TEST_F(ExposureWindowTest, WithoutAMessageTheParameterOfTheMomentHolds) {
  parameters.exposure_time_ns = 5 * kMs;
  ExposureWindow by_parameter(kStamp, false);
  EXPECT_EQ(by_parameter.length(parameters), 5 * kMs);
  parameters.exposure_time_ns = 6 * kMs;
  EXPECT_EQ(by_parameter.length(parameters), 6 * kMs);
  EXPECT_EQ(window.length(parameters), kLength);
}

TEST_F(ExposureWindowTest, IsReadyOnceAnEventIsAsLateAsItsEnd) {
  takeEvents({start, end - 1});
  EXPECT_EQ(state(), FrameState::kWaitingForEvents);
  takeEvents({end});
  EXPECT_EQ(state(), FrameState::kReady);
}

TEST_F(ExposureWindowTest, OutOfTimeItIsReadyWithWhatHasCome) {
  takeEvents({start});
  EXPECT_EQ(state(true), FrameState::kReady);
}

TEST_F(ExposureWindowTest, WithoutAnEventAsLateAsItsStartTheSceneIsStillOnlyInSilence) {
  takeEvents({start - 5 * kMs});
  EXPECT_EQ(state(true), FrameState::kReady);
  traits.clocks_differed = true;
  EXPECT_EQ(reason(true), PassReason::kEventsMissing);
  traits.clocks_differed = false;
  traits.stream_silent = false;
  EXPECT_EQ(reason(true), PassReason::kEventsMissing);
  takeEvents({start});
  EXPECT_EQ(state(true), FrameState::kReady);
}

TEST_F(ExposureWindowTest, MoreThanASecondAwayTheClocksDiffer) {
  traits.stream_silent = false;
  takeEvents({start - kClocksDiffer_ns - 1});
  EXPECT_EQ(reason(true), PassReason::kClocksDiffer);
  takeEvents({start - kClocksDiffer_ns});
  EXPECT_EQ(reason(true), PassReason::kEventsMissing);
}

TEST_F(ExposureWindowTest, TheTimeOffsetShiftsTheEventsOnly) {
  parameters.time_offset_ns = 3 * kMs;
  EXPECT_EQ(window.inFrameTime(parameters), (ExposureInterval{start, end}));
  EXPECT_EQ(window.inEventTime(parameters), (ExposureInterval{start + 3 * kMs, end + 3 * kMs}));
  takeEvents({start + 3 * kMs, end});
  EXPECT_EQ(state(), FrameState::kWaitingForEvents);
  takeEvents({end + 3 * kMs});
  EXPECT_EQ(state(), FrameState::kReady);
}

TEST_F(ExposureWindowTest, WaitsForTheFirstEventArrayUntilOutOfTime) {
  EXPECT_EQ(state(), FrameState::kWaitingForEvents);
  EXPECT_EQ(reason(true), PassReason::kNoEventStream);
}

TEST_F(ExposureWindowTest, PassesThroughWhatBeganBeforeTheEvents) {
  takeEvents({start + EventCoverage::kStartSlack_ns + 1, end});
  EXPECT_EQ(reason(), PassReason::kEventsMissing);
}

TEST_F(ExposureWindowTest, PassesThroughAnotherSize) {
  traits.size = {4, 4};
  takeEvents({start, end});
  EXPECT_EQ(reason(), PassReason::kSizeMismatch);
}

TEST_F(ExposureWindowTest, PassesThroughWhatItCannotReadAfterItsMessageHasCome) {
  traits.supported = false;
  EXPECT_EQ(reason(), PassReason::kUnsupportedEncoding);
  const ExposureWindow fresh(kStamp, true);
  EXPECT_EQ(fresh.judge(traits, events, parameters, false).state, FrameState::kWaitingForExposure);
}

TEST_F(ExposureWindowTest, PassesThroughAnUnknownExposure) {
  window.settle(std::nullopt);
  takeEvents({start, end});
  EXPECT_EQ(reason(), PassReason::kExposureUnknown);
}

TEST_F(ExposureWindowTest, PassthroughWaitsForNothing) {
  parameters.passthrough = true;
  const ExposureWindow fresh(kStamp, true);
  const FrameVerdict verdict = fresh.judge(traits, events, parameters, false);
  EXPECT_EQ(verdict.state, FrameState::kPassThrough);
  EXPECT_EQ(verdict.reason, PassReason::kPassthroughParameter);
}

TEST_F(ExposureWindowTest, AfterAJumpBackOfTheFramesItWaitsForThatOfTheEvents) {
  takeEvents({end + 10 * kNanosecondsPerSecond});
  EXPECT_EQ(reason(), PassReason::kClocksDiffer);
  traits.after_time_jump = true;
  EXPECT_EQ(state(), FrameState::kWaitingForEventJump);
  EXPECT_EQ(reason(true), PassReason::kClocksDiffer);
  takeEvents({start, start + 1, end});
  EXPECT_EQ(state(), FrameState::kReady);
}

TEST_F(ExposureWindowTest, AfterAJumpBackWithinReachOfTheEventsItDoesNotWait) {
  traits.after_time_jump = true;
  takeEvents({end + parameters.max_backward_jump_ns});
  EXPECT_EQ(reason(), PassReason::kEventsMissing);
}

}  // namespace
}  // namespace fast_edi
