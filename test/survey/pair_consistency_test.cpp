// What frames and events say, for exposures that are assumed.
#include "survey/pair_consistency.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "simulation/davis_simulator.hpp"
#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr double kMs = static_cast<double>(kNanosecondsPerMillisecond);

TEST(PairConsistencyTest, ExposuresFollowFromStamps) {
  SampledFrame frame;
  frame.stamp_ns = 100'000'000;
  WindowModel model;
  EXPECT_FALSE(modelledExposure(frame, model));
  frame.length_ns = 20'000'000;
  frame.previous_length_ns = 10'000'000;
  EXPECT_EQ(*modelledExposure(frame, model), (ExposureInterval{90'000'000, 110'000'000}));
  model.part = 0.5;
  model.shift_ns = 1e6;
  EXPECT_EQ(*modelledExposure(frame, model), (ExposureInterval{101'000'000, 121'000'000}));
  model.length_of_previous = true;
  EXPECT_EQ(*modelledExposure(frame, model), (ExposureInterval{101'000'000, 111'000'000}));
  model.length_ns = 4e6;
  EXPECT_EQ(modelledExposure(frame, model)->length(), 4'000'000);
}

/// The middle pair of frames of an ideal sensor.
class PairConsistencySimulation : public ::testing::Test {
 protected:
  PairConsistencySimulation() {
    SimulationSettings settings;
    settings.sensor = SensorSettings::ideal();
    settings.sensor.size = {120, 90};
    settings.motion.kind = MotionKind::kPan;
    settings.timing.frames = 4;
    thresholds_ = settings.sensor.thresholds;
    const SimulatedSequence sequence = simulateSequence(settings);
    const ExposureInterval all{sequence.frames[0].exposure.start_ns,
                               sequence.frames[3].exposure.end_ns};
    TimingSampler sampler(settings.sensor.size, {{1, all}});
    sampler.addEvents(testing::wireView(testing::toWire(sequence.events)), settings.sensor.size);
    for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
      const SimulatedFrame& simulated = sequence.frames[i];
      SampledFrame frame;
      frame.stamp_ns = simulated.exposure.at(ExposureInstant::kMid);
      frame.length_ns = simulated.exposure.length();
      ImageView image;
      image.data = simulated.blurry.data;
      image.size = settings.sensor.size;
      image.step = simulated.blurry.step;
      sampler.addFrame(i, frame, image);
    }
    size_ = sampler.grid().size();
    sample_ = std::move(sampler.take().at(0));
  }

  Consistency at(double shift_ms, double threshold_factor = 1.0) {
    WindowModel model;
    model.shift_ns = shift_ms * kMs;
    return PairConsistency(size_)
        .measure(sample_, model,
                 {threshold_factor * thresholds_.on, threshold_factor * thresholds_.off})
        .value();
  }

  ContrastThresholds thresholds_;
  SensorSize size_;
  TimingSample sample_;
};

TEST_F(PairConsistencySimulation, TheTrueExposuresFitBest) {
  EXPECT_GT(at(0.0).correlation, 0.9);
  for (const double shift_ms : {-20.0, -10.0, -3.0, 3.0, 10.0, 20.0}) {
    EXPECT_GT(at(shift_ms).cost, at(0.0).cost) << shift_ms;
    EXPECT_LT(at(shift_ms).correlation, at(0.0).correlation) << shift_ms;
  }
}

/// Within what the fit of a single pair can tell.
TEST_F(PairConsistencySimulation, ThresholdsNearTheTrueOnesFitBest) {
  double best = 0.0;
  double least = INFINITY;
  for (const double factor : {0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4}) {
    const double cost = at(0.0, factor).cost;
    if (cost < least) {
      least = cost;
      best = factor;
    }
  }
  EXPECT_GE(best, 1.0);
  EXPECT_LE(best, 1.1);
}

TEST_F(PairConsistencySimulation, ShiftsBeyondTheEventsAreNotMeasured) {
  WindowModel model;
  model.shift_ns = -60.0 * kMs;
  EXPECT_FALSE(PairConsistency(size_).measure(sample_, model, thresholds_));
  model.shift_ns = 60.0 * kMs;
  EXPECT_FALSE(PairConsistency(size_).measure(sample_, model, thresholds_));
}

TEST_F(PairConsistencySimulation, PixelsThatTellNothingAreLeftOut) {
  markInformative(sample_, {sample_.first.stamp_ns, sample_.second.stamp_ns});
  std::size_t telling = 0;
  for (const std::uint8_t tells : sample_.informative) {
    telling += tells;
  }
  EXPECT_GT(telling, 500U);
  EXPECT_LT(telling, size_.pixelCount() * 3 / 4);
  const double correlation = at(0.0).correlation;
  sample_.informative.assign(size_.pixelCount(), 0);
  EXPECT_FALSE(PairConsistency(size_).measure(sample_, {}, thresholds_));
  EXPECT_GT(correlation, 0.9);
}

}  // namespace
}  // namespace fast_edi
