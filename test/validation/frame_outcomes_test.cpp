// Frames counted without their pixels, as the pipeline counts them.
#include "validation/frame_outcomes.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kZero = 1000 * kNanosecondsPerSecond;
constexpr SensorSize kSize{16, 12};

DeblurParameters someParameters() {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.25};
  return parameters;
}

class FrameOutcomesTest : public ::testing::Test {
 protected:
  void events(std::int64_t from_ms, std::int64_t to_ms) {
    const auto list = testing::makeEvents(
        testing::EventScene::kUniform,
        {kSize, 1000, kZero + from_ms * kMs, (to_ms - from_ms) * kMs, ++sequence_});
    outcomes_.addEvents(testing::wireView(testing::toWire(list)), kSize, sequence_,
                        kZero + (to_ms + 1) * kMs);
  }
  void frame(std::int64_t stamp_ms, std::int64_t record_ms, const std::string& fault = "") {
    FrameMessage frame;
    frame.stamp_ns = kZero + stamp_ms * kMs;
    frame.record_ns = kZero + record_ms * kMs;
    frame.size = kSize;
    frame.fault = fault;
    outcomes_.addFrame(frame);
    outcomes_.addExposure(20'000, frame.record_ns);
  }
  std::uint64_t passed(PassReason reason) const {
    return outcomes_.counters().frames_passed[static_cast<std::size_t>(reason)];
  }

  FrameOutcomes outcomes_{someParameters()};
  std::uint32_t sequence_ = 0;
};

TEST_F(FrameOutcomesTest, NothingIsRenderedAndAllIsCounted) {
  events(0, 50);
  frame(5, 51);                // begins before the events
  frame(30, 52);               // covered
  frame(35, 53, "no format");  // its encoding is unknown
  frame(35, 54);               // stamped as the one before
  frame(9000, 55);             // nowhere near
  events(50, 60);
  outcomes_.finish();
  EXPECT_EQ(outcomes_.counters().frames_deblurred, 1u);
  EXPECT_EQ(passed(PassReason::kEventsMissing), 1u);
  EXPECT_EQ(passed(PassReason::kUnsupportedEncoding), 1u);
  EXPECT_EQ(passed(PassReason::kClocksDiffer), 1u);
  EXPECT_EQ(
      outcomes_.describe(),
      "1 deblurred, 3 passed through unchanged (1 encoding not supported, 1 events missing in "
      "the exposure, 1 clocks differ), 1 without output: stamp not later than the one before");
}

TEST_F(FrameOutcomesTest, AStillSceneIsNamed) {
  events(0, 50);
  frame(100, 160);
  outcomes_.finish();
  EXPECT_THAT(outcomes_.describe(),
              HasSubstr("1 deblurred (1 of them without any event: a still scene), 0 passed"));
}

TEST(FrameOutcomes, ParametersAreChecked) {
  EXPECT_THROW(FrameOutcomes(DeblurParameters{}), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
