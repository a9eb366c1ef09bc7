#include "pipeline/parameter_refinement.hpp"

#include <gtest/gtest.h>

#include "pipeline/window_integral.hpp"
#include "simulation/davis_simulator.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{120, 90};
constexpr double kTooLow = 0.75;  ///< of the true thresholds

DeblurParameters tooLow() {
  const ContrastThresholds truth = SimulationSettings{}.sensor.thresholds;
  DeblurParameters parameters;
  parameters.thresholds = {kTooLow * truth.on, kTooLow * truth.off};
  return parameters;
}

/// Learns from a simulated camera that shakes.
void learnFromFrames(ParameterRefinement& refinement, DeblurCounters& counters) {
  SimulationSettings settings;
  settings.sensor.size = kSize;
  settings.motion.kind = MotionKind::kShake;
  settings.motion.focal_length_px = 110.0;
  settings.scene.tags = 1;
  settings.timing.exposure_us = 30'000;
  settings.timing.frames = 9;
  settings.seed = 3;
  const SimulatedSequence sequence = simulateSequence(settings);
  EventStream events({}, counters, [](StreamReset, std::int64_t) {});
  events.take(testing::wireView(testing::toWire(sequence.events)), kSize, {});
  WindowIntegral integral;
  for (const SimulatedFrame& frame : sequence.frames) {
    ASSERT_TRUE(integral.prepare(events, refinement.inForce(), true));
    const std::int64_t mid_ns = frame.exposure.at(ExposureInstant::kMid);
    integral.integrate(*events.lists(), frame.exposure, mid_ns, WindowIntegral::Counting::kNone);
    if (!refinement.wantsFrame()) {
      refinement.skipFrame();
      continue;
    }
    refinement.keepGains(integral.gains());
    const InputFrame input =
        testing::makeFrame(mid_ns, kSize, {frame.blurry.datastart, frame.blurry.dataend});
    refinement.learn(input.image, frame.exposure, mid_ns, events, counters);
    integral.adopt(refinement.inForce());
  }
}

TEST(ParameterRefinement, WantsFramesOnlyWhereThereIsSomethingToLearn) {
  DeblurParameters parameters;
  EXPECT_TRUE(ParameterRefinement(parameters).wantsFrame());
  parameters.refine_contrast = false;
  EXPECT_TRUE(ParameterRefinement(parameters).wantsFrame());
  parameters.refine_delay = false;
  EXPECT_FALSE(ParameterRefinement(parameters).wantsFrame());
  parameters.refine_contrast = true;
  parameters.filter.enabled = false;
  EXPECT_FALSE(ParameterRefinement(parameters).wantsFrame());
}

TEST(ParameterRefinement, PutsLearnedThresholdsInForceUntilTheEventsAreLost) {
  const DeblurParameters given = tooLow();
  ParameterRefinement refinement(given);
  DeblurCounters counters;
  learnFromFrames(refinement, counters);
  EXPECT_GT(counters.calibration_fits, 0u);
  EXPECT_NE(refinement.inForce().thresholds, given.thresholds);
  EXPECT_EQ(refinement.requested().thresholds, given.thresholds);
  EXPECT_EQ(static_cast<std::uint64_t>(refinement.learnedPairs()), counters.calibration_fits);
  refinement.reset();
  EXPECT_EQ(refinement.learnedPairs(), 0);
  EXPECT_EQ(refinement.inForce().thresholds, given.thresholds);
  EXPECT_EQ(refinement.eventDelay(), 0);
  EXPECT_EQ(refinement.neededFrom(INT64_MAX), INT64_MAX);
}

TEST(ParameterRefinement, OtherParametersKeepWhatWasLearnedUnlessItWouldBeLearnedDifferently) {
  DeblurParameters parameters = tooLow();
  ParameterRefinement refinement(parameters);
  DeblurCounters counters;
  learnFromFrames(refinement, counters);
  const ContrastThresholds learned = refinement.inForce().thresholds;
  ASSERT_NE(learned, parameters.thresholds);
  parameters.filter.temporal = 0.5;
  refinement.setParameters(parameters);
  EXPECT_EQ(refinement.inForce().thresholds, learned);
  EXPECT_EQ(refinement.inForce().filter.temporal, 0.5);
  parameters.weighting = Weighting::kCounter;
  refinement.setParameters(parameters);
  EXPECT_EQ(refinement.inForce().thresholds, parameters.thresholds);
}

}  // namespace
}  // namespace fast_edi
