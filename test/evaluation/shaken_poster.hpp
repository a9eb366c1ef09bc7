/// \file
/// A small recording with strong blur, for tests that need the truth.
#pragma once

#include "fast_edi/pipeline/deblurrer.hpp"
#include "simulation/davis_simulator.hpp"

namespace fast_edi {
namespace testing {

constexpr SensorSize kPosterSize{120, 90};

inline SimulationSettings shakenPoster(const SensorSettings& sensor) {
  SimulationSettings settings;
  settings.sensor = sensor;
  settings.sensor.size = kPosterSize;
  settings.scene.tags = 1;
  settings.motion.kind = MotionKind::kShake;
  settings.motion.focal_length_px = 110.0;
  settings.timing.frames = 6;
  settings.timing.exposure_us = 30'000;
  settings.seed = 5;
  return settings;
}

/// The sensor's true mean thresholds and its exposure.
inline DeblurParameters parametersFor(const SimulationSettings& settings) {
  DeblurParameters parameters;
  parameters.thresholds = settings.sensor.thresholds;
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = settings.timing.exposure_us * kNanosecondsPerMicrosecond;
  return parameters;
}

}  // namespace testing
}  // namespace fast_edi
