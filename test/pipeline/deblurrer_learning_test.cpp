// What the pipeline has learned from a recording, when its parameters change.
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "simulation/davis_simulator.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{120, 90};
constexpr std::size_t kFrames = 9;
constexpr std::size_t kBeforeTheChange = kFrames - 1;
constexpr double kTooLow = 0.75;  ///< of the true thresholds

const SimulatedSequence& sequence() {
  static const SimulatedSequence simulated = [] {
    SimulationSettings settings;
    settings.sensor.size = kSize;
    settings.motion.kind = MotionKind::kShake;
    settings.motion.focal_length_px = 110.0;
    settings.scene.tags = 1;
    settings.timing.exposure_us = 30'000;
    settings.timing.frames = kFrames;
    settings.seed = 3;
    return simulateSequence(settings);
  }();
  return simulated;
}

/// A pipeline with thresholds that are too low, and what it has learned from some frames.
class DeblurrerLearning : public ::testing::Test {
 protected:
  static DeblurParameters start() {
    DeblurParameters parameters;
    const ContrastThresholds truth = SimulationSettings{}.sensor.thresholds;
    parameters.thresholds = {kTooLow * truth.on, kTooLow * truth.off};
    parameters.exposure_source = ExposureSource::kParameter;
    parameters.exposure_time_ns = sequence().frames.front().exposure.length();
    return parameters;
  }

  static void feed(Deblurrer& deblurrer, std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const SimulatedFrame& frame = sequence().frames.at(i);
      deblurrer.addFrame(testing::makeFrame(frame.exposure.at(ExposureInstant::kMid), kSize,
                                            {frame.blurry.datastart, frame.blurry.dataend}),
                         0);
    }
  }

  DeblurrerLearning() {
    deblurrer.addEvents(testing::wireView(testing::toWire(sequence().events)), kSize, 1, 0);
    feed(deblurrer, 0, kBeforeTheChange);
  }

  /// Pixels of the last frame by a pipeline that knows nothing of those before.
  static std::vector<std::uint8_t> lastFrameAfresh(const DeblurParameters& parameters) {
    testing::RecordingSink other_sink;
    Deblurrer fresh(parameters, other_sink);
    fresh.addEvents(testing::wireView(testing::toWire(sequence().events)), kSize, 1, 0);
    feed(fresh, kBeforeTheChange, kFrames);
    EXPECT_EQ(fresh.counters().frames_deblurred, 1u);
    return other_sink.outputs.back().pixels;
  }

  void expectForgotten(const DeblurParameters& changed) {
    deblurrer.setParameters(changed);
    EXPECT_EQ(deblurrer.status().thresholds, changed.thresholds);
    EXPECT_EQ(deblurrer.status().event_delay_ns, 0);
    feed(deblurrer, kBeforeTheChange, kFrames);
    EXPECT_EQ(deblurrer.counters().frames_deblurred, kFrames);
    EXPECT_EQ(sink.outputs.back().pixels, lastFrameAfresh(changed));
  }

  testing::RecordingSink sink;
  Deblurrer deblurrer{start(), sink};
};

TEST_F(DeblurrerLearning, HasLearnedSomethingToLose) {
  ASSERT_EQ(deblurrer.counters().frames_deblurred, kBeforeTheChange);
  EXPECT_GT(deblurrer.counters().calibration_fits, 0u);
  EXPECT_NE(deblurrer.status().thresholds, start().thresholds);
  feed(deblurrer, kBeforeTheChange, kFrames);
  EXPECT_NE(sink.outputs.back().pixels, lastFrameAfresh(start()));
}

TEST_F(DeblurrerLearning, StartsAnewWithOtherThresholds) {
  DeblurParameters changed = start();
  changed.thresholds.on *= 1.1;
  expectForgotten(changed);
}

TEST_F(DeblurrerLearning, StartsAnewWithAnotherTimeOffset) {
  DeblurParameters changed = start();
  changed.time_offset_ns += kNanosecondsPerMillisecond;
  expectForgotten(changed);
}

TEST_F(DeblurrerLearning, StartsAnewWithAnotherStampReference) {
  DeblurParameters changed = start();
  changed.stamp_reference = ExposureInstant::kEnd;
  // A window that reaches back to where events are gone would be no comparison.
  changed.time_offset_ns = start().exposure_time_ns / 2;
  expectForgotten(changed);
}

TEST_F(DeblurrerLearning, EndsWithTheFilters) {
  DeblurParameters changed = start();
  changed.filter.enabled = false;
  expectForgotten(changed);
}

TEST_F(DeblurrerLearning, OutlastsWhatItDoesNotDependOn) {
  const ContrastThresholds learned = deblurrer.status().thresholds;
  const std::int64_t delay_ns = deblurrer.status().event_delay_ns;
  DeblurParameters changed = start();
  changed.reference = ExposureInstant::kStart;
  changed.filter.gain.spatial_sigma_px = 2.0F;
  changed.close_timeout_ns = 50 * kNanosecondsPerMillisecond;
  deblurrer.setParameters(changed);
  EXPECT_EQ(deblurrer.status().thresholds, learned);
  EXPECT_EQ(deblurrer.status().event_delay_ns, delay_ns);
  EXPECT_EQ(deblurrer.parameters().thresholds, start().thresholds) << "those asked for";
  changed.passthrough = true;
  deblurrer.setParameters(changed);
  EXPECT_EQ(deblurrer.status().thresholds, learned);
}

}  // namespace
}  // namespace fast_edi
