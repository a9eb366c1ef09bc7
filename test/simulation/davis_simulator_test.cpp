// The simulator as an oracle: its events, frames and truth must agree with each other.
#include "simulation/davis_simulator.hpp"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

namespace fast_edi {
namespace {

SimulationSettings smallSettings() {
  SimulationSettings settings;
  settings.sensor = SensorSettings::ideal();
  settings.sensor.size = {96, 72};
  settings.scene.texture = TextureKind::kNatural;
  settings.timing.frames = 3;
  settings.timing.period_us = 30'000;
  settings.timing.exposure_us = 20'000;
  settings.timing.lead_us = 5'000;
  return settings;
}

/// Largest excess of |log irradiance - (initial + sum of thresholds)| over the pixel's threshold.
double largestExcess(const DavisSimulator& simulator, const std::vector<Event>& events,
                     std::int64_t t_ns) {
  cv::Mat1f initial;
  cv::Mat1f now;
  cv::log(simulator.irradianceAt(simulator.settings().timing.start_ns), initial);
  cv::log(simulator.irradianceAt(t_ns), now);
  const std::vector<float>& on = simulator.eventSensor().thresholdsOn();
  const std::vector<float>& off = simulator.eventSensor().thresholdsOff();
  std::vector<double> level(initial.begin(), initial.end());
  for (const Event& event : events) {
    if (event.t_ns >= t_ns) break;
    const std::size_t pixel = event.y * static_cast<std::size_t>(now.cols) + event.x;
    level[pixel] += event.on ? on[pixel] : -static_cast<double>(off[pixel]);
  }
  double excess = -1.0;
  for (std::size_t pixel = 0; pixel < level.size(); ++pixel) {
    const double difference = now(static_cast<int>(pixel)) - level[pixel];
    excess = std::max({excess, difference - on[pixel], -difference - off[pixel]});
  }
  return excess;
}

class OracleTest : public testing::TestWithParam<MotionKind> {};

TEST_P(OracleTest, EventsFollowLogIrradianceWithinOneThreshold) {
  SimulationSettings settings = smallSettings();
  settings.motion.kind = GetParam();
  settings.sensor.threshold_mismatch = 0.1;
  const SimulatedSequence sequence = simulateSequence(settings);
  const DavisSimulator simulator(settings);
  ASSERT_GT(sequence.events.size(), 10'000U);
  // Between two renderings the events follow a chord of the true signal, hence the tolerance.
  constexpr double kChord = 0.03;
  for (const SimulatedFrame& frame : sequence.frames) {
    for (const ExposureInstant instant :
         {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
      EXPECT_LT(largestExcess(simulator, sequence.events, frame.exposure.at(instant)), kChord);
    }
    // At the exposure's ends there is a rendering: exact up to the clock of 1 us.
    EXPECT_LT(largestExcess(simulator, sequence.events, frame.exposure.end_ns), 2e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, OracleTest,
                         testing::Values(MotionKind::kMild, MotionKind::kPan, MotionKind::kSpin,
                                         MotionKind::kShake));

TEST(DavisSimulatorTest, BlurryFrameIsTheMeanOfTheLatentImages) {
  SimulationSettings settings = smallSettings();
  settings.timing.frames = 1;
  settings.sensor.frame_bits = 16;
  const SimulatedSequence sequence = simulateSequence(settings);
  const DavisSimulator simulator(settings);
  const ExposureInterval exposure = sequence.frames[0].exposure;
  constexpr int kSamples = 400;
  cv::Mat1d sum = cv::Mat1d::zeros(72, 96);
  for (int i = 0; i < kSamples; ++i) {
    // Mid-point rule: the middles of equal parts of [start, end).
    const std::int64_t t_ns = exposure.start_ns + exposure.length() * (2 * i + 1) / (2 * kSamples);
    cv::Mat1d latent;
    simulator.latentAt(t_ns).convertTo(latent, CV_64F);
    sum += latent;
  }
  cv::Mat1d blurry;
  sequence.frames[0].blurry.convertTo(blurry, CV_64F);
  // A tenth of an 8-bit grey level.
  EXPECT_LT(cv::norm(sum / kSamples, blurry, cv::NORM_INF), 0.1 * 257.0);
}

TEST(DavisSimulatorTest, SharpFrameIsTheLatentImageAtMidExposure) {
  const SimulationSettings settings = smallSettings();
  const SimulatedSequence sequence = simulateSequence(settings);
  const DavisSimulator simulator(settings);
  for (const SimulatedFrame& frame : sequence.frames) {
    const cv::Mat latent = simulator.latentAt(frame.exposure.at(ExposureInstant::kMid));
    EXPECT_EQ(cv::norm(frame.sharp, latent, cv::NORM_INF), 0.0);
    EXPECT_GT(cv::norm(frame.sharp, frame.blurry, cv::NORM_INF), 20.0);
  }
}

TEST(DavisSimulatorTest, StillCameraGivesSharpFramesAndNoEvents) {
  SimulationSettings settings = smallSettings();
  settings.motion.kind = MotionKind::kStill;
  const SimulatedSequence sequence = simulateSequence(settings);
  EXPECT_TRUE(sequence.events.empty());
  for (const SimulatedFrame& frame : sequence.frames) {
    EXPECT_LE(cv::norm(frame.sharp, frame.blurry, cv::NORM_INF), 1.0);
  }
}

TEST(DavisSimulatorTest, IntervalsJoinAndHoldTheirExposure) {
  const SimulationSettings settings = smallSettings();
  DavisSimulator simulator(settings);
  SimulatedInterval interval;
  std::int64_t end_ns = settings.timing.start_ns;
  int frames = 0;
  while (simulator.next(interval)) {
    EXPECT_EQ(interval.start_ns, end_ns);
    const std::int64_t exposure_start =
        settings.timing.start_ns + (5'000 + frames * 30'000) * kNanosecondsPerMicrosecond;
    EXPECT_EQ(
        interval.frame.exposure,
        (ExposureInterval{exposure_start, exposure_start + 20'000 * kNanosecondsPerMicrosecond}));
    EXPECT_LE(interval.frame.exposure.end_ns, interval.end_ns);
    for (const Event& event : interval.events) {
      ASSERT_GE(event.t_ns, interval.start_ns);
      ASSERT_LE(event.t_ns, interval.end_ns);
    }
    end_ns = interval.end_ns;
    ++frames;
  }
  EXPECT_EQ(frames, 3);
  EXPECT_EQ(end_ns,
            settings.timing.start_ns + (2 * 5'000 + 3 * 30'000) * kNanosecondsPerMicrosecond);
}

bool equalSequences(const SimulatedSequence& a, const SimulatedSequence& b) {
  if (a.events.size() != b.events.size() || a.frames.size() != b.frames.size()) return false;
  for (std::size_t i = 0; i < a.events.size(); ++i) {
    const Event& p = a.events[i];
    const Event& q = b.events[i];
    if (p.x != q.x || p.y != q.y || p.t_ns != q.t_ns || p.on != q.on) return false;
  }
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    if (cv::norm(a.frames[i].blurry, b.frames[i].blurry, cv::NORM_INF) != 0.0) return false;
    if (cv::norm(a.frames[i].sharp, b.frames[i].sharp, cv::NORM_INF) != 0.0) return false;
  }
  return true;
}

TEST(DavisSimulatorTest, EqualSeedsGiveEqualOutputAndOthersDoNot) {
  SimulationSettings settings;  // with all usual noise
  settings.sensor.size = {96, 72};
  settings.timing.frames = 2;
  settings.scene.tags = 1;
  const SimulatedSequence first = simulateSequence(settings);
  EXPECT_TRUE(equalSequences(first, simulateSequence(settings)));
  settings.seed = 2;
  EXPECT_FALSE(equalSequences(first, simulateSequence(settings)));
}

TEST(DavisSimulatorTest, FrameNoiseHasTheVarianceOfReadAndShotNoise) {
  SimulationSettings settings = smallSettings();
  settings.scene.texture = TextureKind::kFlat;
  settings.motion.kind = MotionKind::kStill;
  settings.sensor.size = {200, 200};
  settings.sensor.frame_bits = 16;
  settings.sensor.read_noise_dn = 1.5;
  settings.sensor.electrons_per_dn = 50.0;
  settings.timing.frames = 1;
  const SimulatedFrame frame = simulateSequence(settings).frames[0];
  cv::Mat difference;
  cv::subtract(frame.blurry, frame.sharp, difference, cv::noArray(), CV_64F);
  cv::Scalar bias;
  cv::Scalar deviation;
  cv::meanStdDev(difference / 257.0, bias, deviation);
  const double expected = std::sqrt(1.5 * 1.5 + cv::mean(frame.sharp)[0] / 257.0 / 50.0);
  // 40000 pixels: standard errors 0.5 % and 0.4 % of the deviation.
  EXPECT_NEAR(bias[0], 0.0, 0.02 * expected);
  EXPECT_NEAR(deviation[0], expected, 0.016 * expected);
}

TEST(DavisSimulatorTest, FlickerModulatesTheFramesAndCostsEvents) {
  SimulationSettings settings = smallSettings();
  settings.motion.kind = MotionKind::kStill;
  settings.scene.flicker_hz = 100.0;
  settings.scene.flicker_depth = 0.5;
  const SimulatedSequence sequence = simulateSequence(settings);
  const DavisSimulator simulator(settings);
  // The recording starts where the light's modulation passes zero.
  const std::int64_t start = settings.timing.start_ns;
  const double rest = cv::mean(simulator.irradianceAt(start))[0];
  const double peak = cv::mean(simulator.irradianceAt(start + 2'500'000))[0];
  EXPECT_NEAR(peak / rest, 1.5, 1e-4);
  // 10 periods, in each of which log irradiance rises and falls by log(1.5 / 0.5) = 1.10. Of that
  // one threshold is lost at each turn: (1.10 - 0.25) / 0.25 = 3.4 events each way.
  const double per_pixel =
      static_cast<double>(sequence.events.size()) / static_cast<double>(96 * 72);
  EXPECT_NEAR(per_pixel, 10 * 2 * 3.4, 5.0);
}

TEST(DavisSimulatorTest, BayerPixelsSeeTheirOwnColour) {
  SimulationSettings settings = smallSettings();
  settings.motion.kind = MotionKind::kStill;
  settings.timing.frames = 1;
  settings.scene.texture = TextureKind::kFlat;  // reddish grey: R > G > B
  settings.sensor.colour_filter = ColourFilter::kBayerRggb;
  const cv::Mat1b raw = simulateSequence(settings).frames[0].sharp;
  double sums[2][2] = {};
  for (int y = 0; y < raw.rows; ++y) {
    for (int x = 0; x < raw.cols; ++x) sums[y & 1][x & 1] += raw(y, x);
  }
  EXPECT_GT(sums[0][0], 1.02 * sums[0][1]);
  EXPECT_NEAR(sums[0][1], sums[1][0], 0.01 * sums[0][1]);
  EXPECT_GT(sums[1][0], 1.02 * sums[1][1]);
}

TEST(DavisSimulatorTest, MeanThresholdsAreThoseOfTheDefaultBiases) {
  const SimulationSettings settings;
  EXPECT_DOUBLE_EQ(settings.sensor.thresholds.on, 0.2609);
  EXPECT_DOUBLE_EQ(settings.sensor.thresholds.off, 0.2415);
  EXPECT_EQ(settings.sensor.size, (SensorSize{346, 260}));
}

TEST(DavisSimulatorTest, ImpossibleSettingsAreRefusedByName) {
  const auto messageOf = [](auto change) -> std::string {
    SimulationSettings settings = smallSettings();
    change(settings);
    try {
      const DavisSimulator simulator(settings);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  using testing::HasSubstr;
  EXPECT_THAT(messageOf([](auto& s) { s.timing.exposure_us = 30'001; }),
              HasSubstr("exposure [us]: expected 1 to 30000, got 30001"));
  EXPECT_THAT(messageOf([](auto& s) { s.sensor.thresholds.off = 0.0; }),
              HasSubstr("OFF threshold"));
  EXPECT_THAT(messageOf([](auto& s) { s.sensor.frame_bits = 10; }), HasSubstr("frame bits"));
  EXPECT_THAT(messageOf([](auto& s) { s.timing.start_ns = 1; }), HasSubstr("start [ns]"));
  EXPECT_THAT(messageOf([](auto& s) { s.sensor.photoreceptor_dark_hz = 10.0; }),
              HasSubstr("photoreceptor cut-off"));
  EXPECT_THAT(messageOf([](auto& s) { s.scene.tags = 30; }), HasSubstr("do not fit"));
  EXPECT_THAT(messageOf([](auto& s) { s.scene.texture_file = "/no/such/picture.png"; }),
              HasSubstr("/no/such/picture.png"));
  EXPECT_THROW(textureKindFromName("velvet"), std::invalid_argument);
  EXPECT_THROW(motionKindFromName("teleport"), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
