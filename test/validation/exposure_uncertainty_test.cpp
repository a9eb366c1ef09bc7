// What the estimate of an unknown exposure says of its own uncertainty, against the truth.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "validation/simulated_recording.hpp"

namespace fast_edi {
namespace {

using testing::SimulatedRecording;

struct Case {
  MotionKind motion;
  TextureKind texture;
  std::int64_t exposure_us;
  double true_on;  ///< threshold; the estimate begins from another
};

SimulationSettings settingsOf(const Case& a_case, std::uint64_t seed) {
  SimulationSettings settings;
  settings.sensor.size = {80, 60};
  settings.sensor.thresholds = {a_case.true_on, 0.24};
  settings.sensor.shot_noise_bright_hz = 1.0;
  settings.sensor.shot_noise_dark_hz = 5.0;
  settings.sensor.leak_rate_hz = 0.1;
  settings.motion.kind = a_case.motion;
  settings.scene.texture = a_case.texture;
  settings.timing.frames = 10;
  settings.timing.exposure_us = a_case.exposure_us;
  settings.seed = seed;
  return settings;
}

TEST(ExposureUncertaintyTest, TheTruthLiesWithinTwoSigmasInNineOfTenRecordings) {
  const std::vector<Case> cases = {
      {MotionKind::kPan, TextureKind::kNatural, 10'000, 0.26},
      {MotionKind::kPan, TextureKind::kPoster, 20'000, 0.20},
      {MotionKind::kPan, TextureKind::kNatural, 30'000, 0.30},
      {MotionKind::kShake, TextureKind::kNatural, 15'000, 0.26},
      {MotionKind::kShake, TextureKind::kPoster, 20'000, 0.30},
      {MotionKind::kShake, TextureKind::kNatural, 30'000, 0.22},
      {MotionKind::kSpin, TextureKind::kNatural, 20'000, 0.26},
      {MotionKind::kSpin, TextureKind::kPoster, 30'000, 0.26},
      {MotionKind::kMild, TextureKind::kNatural, 30'000, 0.26},
      {MotionKind::kMild, TextureKind::kPoster, 20'000, 0.22},
  };
  int told = 0;
  int within = 0;
  std::string list;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SimulatedRecording::Told unknown;
    unknown.exposures = false;
    const ValidationReport report =
        SimulatedRecording(settingsOf(cases[i], i + 1)).validate(unknown);
    const TimingEstimate& timing = report.timing;
    const double error =
        std::log(timing.length_ns / static_cast<double>(cases[i].exposure_us * 1000));
    list += textOf("\n%lld us: %.0f us, %.1f sigma of %.0f %%%s",
                   static_cast<long long>(cases[i].exposure_us), timing.length_ns * 1e-3,
                   error / timing.length_sigma, 100.0 * timing.length_sigma,
                   timing.length_told ? "" : ", not told");
    if (timing.length_told) {
      ++told;
      within += std::abs(error) <= 2.0 * timing.length_sigma ? 1 : 0;
    }
  }
  EXPECT_GE(told, 6) << list;
  EXPECT_GE(within, static_cast<int>(std::ceil(0.9 * told))) << list;
}

}  // namespace
}  // namespace fast_edi
