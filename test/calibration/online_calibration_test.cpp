#include "calibration/online_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "calibration/slow_calibration.hpp"
#include "fast_edi/integral/double_integral.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{56, 42};
constexpr std::int64_t kExposure_ns = 20 * kMs;
constexpr std::int64_t kPeriod_ns = 40 * kMs;
constexpr ContrastThresholds kTrue{0.25, 0.2};

/// A sensor whose pixels see brightness ramps that start at different times: exact events of known
/// thresholds, delayed as wanted, and frames that are exact means over their exposures.
/// Thresholds of pixels are kTrue times `mean` in the mean, and differ by up to `spread` times
/// kTrue from that.
class RampScene {
 public:
  struct Thresholds {
    double mean = 1.0;
    double spread = 0.0;
    bool varied =
        false;  ///< grey levels from nearly black to saturated rather than some middle one
  };

  explicit RampScene(std::int64_t delay_ns) : RampScene(delay_ns, Thresholds()) {}
  RampScene(std::int64_t delay_ns, const Thresholds& thresholds)
      : RampScene(delay_ns, delay_ns, thresholds) {}
  /// \param later_delay_ns of the second half
  RampScene(std::int64_t delay_ns, std::int64_t later_delay_ns, const Thresholds& thresholds)
      : thresholds_(thresholds) {
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const bool up = (x + y) % 2 == 0;
        for (int ramp = 0; ramp < kRamps; ++ramp) {
          // Up in one ramp and down in the next, so that grey levels stay in range.
          const bool rises = up == (ramp % 2 == 0);
          const std::int64_t start_ns = rampStart(x, y, ramp);
          for (int k = 1; k <= steps(rises); ++k) {
            events_.push_back(
                {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                 start_ns + k * kStep_ns + (ramp < kRamps / 2 ? delay_ns : later_delay_ns), rises});
          }
        }
      }
    }
    std::sort(events_.begin(), events_.end(),
              [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
    lists_ = std::make_unique<PixelEventLists>(kSize, PixelEventLists::Limits{});
    for (const Event& event : events_) {
      lists_->append(event);
    }
  }

  const PixelEventLists& lists() const { return *lists_; }

  static ExposureInterval exposure(int frame) {
    const std::int64_t start_ns = kStart_ns + frame * kPeriod_ns;
    return {start_ns, start_ns + kExposure_ns};
  }

  std::vector<std::uint8_t> frame(int index) const {
    const ExposureInterval window = exposure(index);
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        constexpr int kSamples = 200;
        double sum = 0.0;
        for (int i = 0; i < kSamples; ++i) {
          sum += std::exp(logLevel(x, y, window.start_ns + (2 * i + 1) * kExposure_ns / 400));
        }
        const double grey =
            thresholds_.varied ? 0.02 * kGrey * (1 + (x * 11 + y * 17) % 67) : kGrey;
        pixels.push_back(
            static_cast<std::uint8_t>(std::lround(std::min(255.0, grey * sum / kSamples))));
      }
    }
    return pixels;
  }

 private:
  static constexpr double kGrey = 75.0;
  static constexpr int kRamps = 10;
  /// As many as make up one natural-log unit, so that levels come back.
  static int steps(bool rises) { return rises ? 4 : 5; }
  static constexpr std::int64_t kStep_ns = 2 * kMs;
  static constexpr std::int64_t kStart_ns = 1000 * kMs;

  static std::int64_t rampStart(int x, int y, int ramp) {
    return kStart_ns + ramp * kPeriod_ns + (x * 37 + y * 101) % 29 * kMs + kMs / 3;
  }

  /// Log level as the events report it, without delay.
  double logLevel(int x, int y, std::int64_t t_ns) const {
    constexpr int kKinds = 11;
    const double share = 2.0 * ((x * 5 + y * 7) % kKinds) / (kKinds - 1) - 1.0;
    const double relative = thresholds_.mean + share * thresholds_.spread;
    const bool up = (x + y) % 2 == 0;
    double level = 0.0;
    for (int ramp = 0; ramp < kRamps; ++ramp) {
      const bool rises = up == (ramp % 2 == 0);
      for (int k = 1; k <= steps(rises); ++k) {
        level += t_ns >= rampStart(x, y, ramp) + k * kStep_ns ? relative * kTrue.step(rises) : 0.0;
      }
    }
    return level;
  }

  Thresholds thresholds_;
  std::vector<Event> events_;
  std::unique_ptr<PixelEventLists> lists_;
};

/// Closes frames as the pipeline does, with what the calibration says.
/// \param seen seen(calibration, frame): after each frame
template <typename Seen>
Calibration calibrated(const RampScene& scene, const Calibration& given,
                       OnlineCalibration::Settings settings, int frames, Seen seen) {
  OnlineCalibration calibration(kSize, given, settings);
  std::vector<float> gain(kSize.pixelCount());
  for (int i = 0; i < frames; ++i) {
    const Calibration now = calibration.inForce();
    ExposureInterval window = RampScene::exposure(i);
    window.start_ns += now.event_delay_ns;
    window.end_ns += now.event_delay_ns;
    DoubleIntegral integral(kSize, now.thresholds, Weighting::kTime);
    const std::int64_t reference_ns = window.at(ExposureInstant::kMid);
    integral.integrate(scene.lists(), window, reference_ns, gain.data());
    const std::vector<std::uint8_t> pixels = scene.frame(i);
    const ImageView image{pixels.data(), kSize, static_cast<std::size_t>(kSize.width),
                          PixelFormat::kMono8};
    const OnlineCalibration::Frame frame{window, reference_ns, image, gain.data()};
    calibration.addFrame(frame, CameraResponse::linear(), scene.lists());
    seen(calibration, frame);
  }
  return calibration.inForce();
}
Calibration calibrated(const RampScene& scene, const Calibration& given,
                       OnlineCalibration::Settings settings, int frames = 10) {
  return calibrated(scene, given, settings, frames,
                    [](const OnlineCalibration&, const OnlineCalibration::Frame&) {});
}

TEST(OnlineCalibration, LearnsWhatASlowReferenceLearns) {
  struct Case {
    std::int64_t delay_ns;
    RampScene::Thresholds thresholds;
    Calibration given;
    OnlineCalibration::Settings settings;
    std::int64_t further_delay_ns = 0;  ///< in the second half
  };
  for (const Case& one :
       {Case{0, {1.0, 0.3, true}, {{0.8 * kTrue.on, 1.2 * kTrue.off}}, {true, false}},
        {0, {0.92, 0.05, true}, {kTrue}, {true, true}},
        {0, {0.89, 0.25, true}, {kTrue}, {true, true}},
        {2 * kMs, {1.0, 0.1, true}, {{0.8 * kTrue.on, 0.85 * kTrue.off}, kMs}, {true, true}},
        {-2 * kMs, {1.0, 0.2, false}, {kTrue, -kMs}, {false, true}},
        {0, {1.0, 0.0, true}, {{2.0 * kTrue.on, 0.6 * kTrue.off}, -kMs}, {true, false}},
        {4 * kMs, {1.0, 0.1, false}, {kTrue}, {true, true}, -4 * kMs},
        {0, {1.0, 0.2, true}, {kTrue}, {false, true}, 4 * kMs}}) {
    testing::SlowCalibration slow(kSize, one.given, one.settings);
    const RampScene scene(one.delay_ns, one.delay_ns + one.further_delay_ns, one.thresholds);
    calibrated(scene, one.given, one.settings, 10,
               [&](const OnlineCalibration& found, const OnlineCalibration::Frame& frame) {
                 slow.addFrame(frame, scene.lists());
                 EXPECT_NEAR(found.inForce().thresholds.on, slow.inForce().thresholds.on, 1e-5);
                 EXPECT_NEAR(found.inForce().thresholds.off, slow.inForce().thresholds.off, 1e-5);
                 EXPECT_NEAR(static_cast<double>(found.inForce().event_delay_ns),
                             static_cast<double>(slow.inForce().event_delay_ns), 500.0);
                 EXPECT_EQ(found.fits(), slow.fits());
               });
  }
}

TEST(OnlineCalibration, FindsThresholdsThatAreTwentyPercentOff) {
  const RampScene scene(0);
  for (const double factor : {0.8, 1.2}) {
    const Calibration found =
        calibrated(scene, {{factor * kTrue.on, factor * kTrue.off}}, {true, false});
    EXPECT_NEAR(found.thresholds.on / kTrue.on, 1.0, 0.04) << factor;
    EXPECT_NEAR(found.thresholds.off / kTrue.off, 1.0, 0.04) << factor;
    EXPECT_EQ(found.event_delay_ns, 0);
  }
}

TEST(OnlineCalibration, LeavesRightThresholdsAlone) {
  const Calibration found = calibrated(RampScene(0), {kTrue}, {true, true});
  EXPECT_EQ(found.thresholds, kTrue);
  EXPECT_LT(std::abs(found.event_delay_ns), kMs / 5);
}

TEST(OnlineCalibration, LeavesNearlyRightThresholdsAlone) {
  const ContrastThresholds nominal{0.96 * kTrue.on, 1.04 * kTrue.off};
  EXPECT_EQ(calibrated(RampScene(0), {nominal}, {true, true}).thresholds, nominal);
}

TEST(OnlineCalibration, BelievesACorrectionThatExplainsTheFramesBetter) {
  constexpr double kLower = 0.9;
  const Calibration found = calibrated(RampScene(0, {kLower, 0.0}), {kTrue}, {true, true});
  EXPECT_NEAR(found.thresholds.on / kTrue.on, kLower, 0.02);
  EXPECT_NEAR(found.thresholds.off / kTrue.off, kLower, 0.02);
}

TEST(OnlineCalibration, DoesNotBelieveItWherePixelsDifferByMore) {
  const Calibration found = calibrated(RampScene(0, {0.9, 0.3}), {kTrue}, {true, true});
  EXPECT_NEAR(found.thresholds.on / kTrue.on, 1.0, 0.01);
  EXPECT_NEAR(found.thresholds.off / kTrue.off, 1.0, 0.01);
}

/// Of a delay, what is left without the lag of steps.
double pixelDelay(std::int64_t mean_ns) {
  constexpr double kStepLag_ns = 0.4 * kMs;
  const auto mean = static_cast<double>(mean_ns);
  return mean > 0.0 ? std::max(0.0, mean - kStepLag_ns) : mean;
}

TEST(OnlineCalibration, FindsTheDelayOfTheEvents) {
  for (const std::int64_t delay_ns : {-2 * kMs, 1 * kMs, 3 * kMs}) {
    const Calibration found = calibrated(RampScene(delay_ns), {kTrue}, {false, true});
    EXPECT_NEAR(static_cast<double>(found.event_delay_ns), pixelDelay(delay_ns),
                0.6 * kMs);  // events of a ramp are 2 ms apart
    EXPECT_EQ(found.thresholds, kTrue);
  }
}

TEST(OnlineCalibration, FindsBothAtOnce) {
  const Calibration found =
      calibrated(RampScene(2 * kMs), {{0.8 * kTrue.on, 0.85 * kTrue.off}}, {true, true});
  EXPECT_NEAR(found.thresholds.on / kTrue.on, 1.0, 0.05);
  EXPECT_NEAR(found.thresholds.off / kTrue.off, 1.0, 0.05);
  EXPECT_NEAR(static_cast<double>(found.event_delay_ns), pixelDelay(2 * kMs), 0.5 * kMs);
}

TEST(OnlineCalibration, StartsFromTheGivenDelay) {
  const Calibration given{kTrue, 2 * kMs};
  OnlineCalibration calibration(kSize, given, {true, true});
  EXPECT_EQ(calibration.inForce().event_delay_ns, given.event_delay_ns);
  // A fixed one stays, whatever the frames say.
  const Calibration fixed = calibrated(RampScene(0), given, {true, false});
  EXPECT_EQ(fixed.event_delay_ns, given.event_delay_ns);
}

TEST(OnlineCalibration, FindsTheSameDelayFromWhereverItStarts) {
  for (const std::int64_t given_ns : {-1 * kMs, 1 * kMs, 4 * kMs}) {
    const Calibration found = calibrated(RampScene(3 * kMs), {kTrue, given_ns}, {false, true});
    EXPECT_NEAR(static_cast<double>(found.event_delay_ns), pixelDelay(3 * kMs), 0.6 * kMs)
        << given_ns;
  }
}

/// As where events waited in a queue that is empty again.
TEST(OnlineCalibration, FollowsADelayThatBeginsOrEnds) {
  for (const std::int64_t further_ns : {-4 * kMs, 4 * kMs}) {
    const std::int64_t first_ns = further_ns < 0 ? 4 * kMs : 0;
    const RampScene scene(first_ns, first_ns + further_ns, {1.0, 0.1});
    const Calibration found = calibrated(scene, {kTrue}, {false, true});
    EXPECT_NEAR(static_cast<double>(found.event_delay_ns), pixelDelay(first_ns + further_ns),
                0.6 * kMs)
        << further_ns;
  }
}

TEST(OnlineCalibration, KeepsAGivenDelayThatNothingSpeaksAgainst) {
  const std::int64_t given_ns = std::llround(pixelDelay(3 * kMs));
  const Calibration found = calibrated(RampScene(3 * kMs), {kTrue, given_ns}, {false, true}, 2);
  EXPECT_NEAR(static_cast<double>(found.event_delay_ns), pixelDelay(3 * kMs), 0.4 * kMs);
}

TEST(OnlineCalibration, APartOfManyEventsIsEnough) {
  // Some 12,000 events in a pair: every sixth row.
  const Calibration found =
      calibrated(RampScene(0), {{0.8 * kTrue.on, 1.2 * kTrue.off}}, {true, false, 2000});
  EXPECT_NEAR(found.thresholds.on / kTrue.on, 1.0, 0.05);
  EXPECT_NEAR(found.thresholds.off / kTrue.off, 1.0, 0.05);
}

TEST(OnlineCalibration, APartOfTheEventsIsEnoughAfterTheFirstFits) {
  OnlineCalibration::Settings settings{true, false};
  settings.initial_fits = 0;
  const Calibration given{{0.8 * kTrue.on, 1.2 * kTrue.off}};
  const Calibration all = calibrated(RampScene(0), given, settings);
  settings.settled_events = 2000;
  const Calibration some = calibrated(RampScene(0), given, settings);
  EXPECT_NEAR(some.thresholds.on / kTrue.on, 1.0, 0.05);
  EXPECT_NEAR(some.thresholds.off / kTrue.off, 1.0, 0.05);
  EXPECT_FALSE(some.thresholds == all.thresholds) << "all events were used";
}

TEST(OnlineCalibration, StaysWithinItsLimits) {
  const Calibration found =
      calibrated(RampScene(0), {{2.5 * kTrue.on, 0.4 * kTrue.off}}, {true, false});
  EXPECT_GE(found.thresholds.on, 0.7 * 2.5 * kTrue.on - 1e-12);
  EXPECT_LE(found.thresholds.off, 1.3 * 0.4 * kTrue.off + 1e-12);
}

/// Two frames and a list of events that the test chooses.
class OnlineCalibrationPair : public ::testing::Test {
 protected:
  CalibrationOutcome addFrame(std::int64_t start_ns) {
    const ExposureInterval window{start_ns, start_ns + kExposure_ns};
    return calibration.addFrame(
        {window,
         window.at(ExposureInstant::kMid),
         {pixels.data(), kSize, static_cast<std::size_t>(kSize.width), PixelFormat::kMono8},
         gain.data()},
        CameraResponse::linear(), lists);
  }
  void eventsIn(std::int64_t from_ns, std::int64_t to_ns) {
    for (std::int64_t t_ns = from_ns; t_ns < to_ns; t_ns += kMs / 50) {
      const auto i = static_cast<std::uint64_t>(t_ns / (kMs / 50));
      lists.append({static_cast<std::uint16_t>(i * 7 % 40), static_cast<std::uint16_t>(i * 3 % 30),
                    t_ns, i % 2 == 0});
    }
  }

  /// Two frames, of which the second is darker by five OFF events, and five events of each pixel,
  /// or of so many, between them.
  CalibrationOutcome darken(bool on, std::size_t count = kSize.pixelCount()) {
    constexpr int kSteps = 5;
    for (int step = 0; step < kSteps; ++step) {
      for (std::size_t i = 0; i < count; ++i) {
        lists.append({static_cast<std::uint16_t>(i % kSize.width),
                      static_cast<std::uint16_t>(i / kSize.width),
                      kExposure_ns + step * kMs + static_cast<std::int64_t>(i), on});
      }
    }
    constexpr std::uint8_t kBright_dn = 200;
    std::fill(pixels.begin(), pixels.end(), kBright_dn);
    addFrame(0);
    std::fill(pixels.begin(), pixels.end(),
              static_cast<std::uint8_t>(std::lround(kBright_dn * std::exp(-kSteps * kTrue.off))));
    return addFrame(kPeriod_ns);
  }

  OnlineCalibration calibration{kSize, {kTrue}, {true, true}};
  PixelEventLists lists{kSize, {}};
  std::vector<std::uint8_t> pixels = std::vector<std::uint8_t>(kSize.pixelCount(), 100);
  std::vector<float> gain = std::vector<float>(kSize.pixelCount(), 1.0F);
};

TEST_F(OnlineCalibrationPair, RecognisesAStreamWithoutEventsBetweenExposures) {
  eventsIn(0, kExposure_ns);
  eventsIn(kPeriod_ns, kPeriod_ns + kExposure_ns);
  EXPECT_EQ(addFrame(0), CalibrationOutcome::kNoPair);
  EXPECT_EQ(addFrame(kPeriod_ns), CalibrationOutcome::kNoEventsBetween);
  EXPECT_EQ(calibration.inForce().thresholds, kTrue);
}

TEST_F(OnlineCalibrationPair, NoiseAloneTeachesNothing) {
  eventsIn(0, kPeriod_ns + kExposure_ns);
  addFrame(0);
  EXPECT_EQ(addFrame(kPeriod_ns), CalibrationOutcome::kTooFewPixels);
  EXPECT_EQ(calibration.inForce().thresholds, kTrue);
}

TEST_F(OnlineCalibrationPair, LearnsFromEventsThatTellWhatTheFramesShow) {
  EXPECT_EQ(darken(false), CalibrationOutcome::kFitted);
  EXPECT_EQ(calibration.inForce().thresholds, kTrue);
}

TEST_F(OnlineCalibrationPair, LearnsFromFiftyPixels) {
  EXPECT_EQ(darken(false, 50), CalibrationOutcome::kFitted);
}

TEST_F(OnlineCalibrationPair, LearnsNothingFromFewer) {
  EXPECT_EQ(darken(false, 49), CalibrationOutcome::kTooFewPixels);
}

TEST_F(OnlineCalibrationPair, LearnsNothingFromEventsThatContradictTheFrames) {
  EXPECT_EQ(darken(true), CalibrationOutcome::kContradiction);
  EXPECT_EQ(calibration.inForce().thresholds, kTrue);
  EXPECT_EQ(calibration.inForce().event_delay_ns, 0);
}

TEST_F(OnlineCalibrationPair, RestsWhenNothingIsToBeLearned) {
  eventsIn(0, (OnlineCalibration::kMaxUselessPairs + 1) * kPeriod_ns);
  for (int i = 0; i <= OnlineCalibration::kMaxUselessPairs; ++i) {
    EXPECT_TRUE(calibration.wantsNextFrame()) << i;
    addFrame(i * kPeriod_ns);
  }
  for (int i = 0; i < OnlineCalibration::kRestFrames; ++i) {
    EXPECT_FALSE(calibration.wantsNextFrame()) << i;
    EXPECT_EQ(calibration.neededFrom(), INT64_MAX);
    calibration.skipFrame();
  }
  EXPECT_TRUE(calibration.wantsNextFrame());
}

TEST_F(OnlineCalibrationPair, RestsAfterAPairOfManyEventsInProportion) {
  eventsIn(0, kPeriod_ns + kExposure_ns);
  const std::uint64_t events = lists.lowerBound(kPeriod_ns + kExposure_ns);
  calibration = OnlineCalibration(kSize, {kTrue}, {true, true, events / 3});
  addFrame(0);
  addFrame(kPeriod_ns);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(calibration.wantsNextFrame()) << i;
    calibration.skipFrame();
  }
  EXPECT_TRUE(calibration.wantsNextFrame());
}

TEST_F(OnlineCalibrationPair, AfterAnInterruptionTheNextFrameHasNoPartner) {
  eventsIn(0, kPeriod_ns + kExposure_ns);
  addFrame(0);
  EXPECT_EQ(calibration.neededFrom(), 0);
  calibration.interrupt();
  EXPECT_EQ(calibration.neededFrom(), INT64_MAX);
  EXPECT_EQ(addFrame(kPeriod_ns), CalibrationOutcome::kNoPair);
}

TEST_F(OnlineCalibrationPair, OverlappingExposuresAreNoPair) {
  eventsIn(0, kPeriod_ns);
  addFrame(0);
  EXPECT_EQ(addFrame(kExposure_ns / 2), CalibrationOutcome::kNoPair);
}

TEST_F(OnlineCalibrationPair, BlackAndSaturatedPixelsAreNoEvidence) {
  for (const std::uint8_t grey : {std::uint8_t{0}, std::uint8_t{255}}) {
    pixels.assign(kSize.pixelCount(), grey);
    // Five ON events for each pixel, far from what the frames show.
    for (int k = 0; k < 5; ++k) {
      for (int i = 0; i < static_cast<int>(kSize.pixelCount()); ++i) {
        lists.append({static_cast<std::uint16_t>(i % kSize.width),
                      static_cast<std::uint16_t>(i / kSize.width), kExposure_ns + k * kMs + i * 100,
                      true});
      }
    }
    calibration.interrupt();
    addFrame(0);
    EXPECT_EQ(addFrame(kPeriod_ns), CalibrationOutcome::kTooFewPixels);
    lists.flush();
  }
}

}  // namespace
}  // namespace fast_edi
