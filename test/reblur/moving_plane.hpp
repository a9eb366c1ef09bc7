/// \file
/// Simulated recordings of a plane whose motion is known, and of a disc that moves before one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "scenes/camera_motion.hpp"
#include "simulation/davis_simulator.hpp"
#include "simulation/sensor_models.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace testing {

constexpr SensorSize kPlaneSize{160, 120};

inline SimulationSettings movingPlane(MotionKind motion, double scale) {
  SimulationSettings settings;
  settings.sensor = sensorModel("davis346");
  settings.sensor.size = kPlaneSize;
  settings.motion.kind = motion;
  settings.motion.scale = scale;
  settings.timing.frames = 2;
  settings.timing.exposure_us = 25'000;
  settings.seed = 5;
  return settings;
}

/// A disc of stones that moves before the wall of \p settings.
class DiscBeforeWall {
 public:
  DiscBeforeWall(const SimulationSettings& settings) : wall_(settings), stones_(stones(settings)) {}

  SimulatedSequence simulate() {
    const SimulationSettings& settings = wall_.settings();
    const TimingSettings& timing = settings.timing;
    EventSensor events(settings.sensor, settings.seed);
    FrameSensor frames(settings.sensor, settings.seed);
    SimulatedSequence sequence;
    std::int64_t t_ns = timing.start_ns;
    cv::Mat1f light = render(t_ns);
    events.begin(t_ns, light);
    for (int i = 0; i < timing.frames; ++i) {
      SimulatedFrame frame;
      frame.exposure.start_ns =
          timing.start_ns + (timing.lead_us + i * timing.period_us) * kNanosecondsPerMicrosecond;
      frame.exposure.end_ns =
          frame.exposure.start_ns + timing.exposure_us * kNanosecondsPerMicrosecond;
      cv::Mat1f sum = cv::Mat1f::zeros(light.size());
      int steps = 0;
      while (t_ns < frame.exposure.end_ns) {
        t_ns += kStepNs;
        const cv::Mat1f next = render(t_ns);
        events.advance(t_ns, next, sequence.events);
        if (t_ns > frame.exposure.start_ns) {
          sum += 0.5 * (light + next);
          ++steps;
        }
        light = next;
      }
      frame.blurry = frames.expose(sum / steps);
      frame.sharp = frames.noiseFree(render(frame.exposure.at(ExposureInstant::kMid)));
      sequence.frames.push_back(frame);
    }
    return sequence;
  }

 private:
  static constexpr std::int64_t kStepNs = 500 * kNanosecondsPerMicrosecond;

  static SimulationSettings stones(SimulationSettings settings) {
    settings.scene.texture = TextureKind::kMosaic;
    settings.motion.kind = MotionKind::kStill;
    return settings;
  }

  cv::Mat1f render(std::int64_t t_ns) const {
    constexpr double kRadius_px = 28.0;
    const double t_s = 1e-9 * static_cast<double>(t_ns - wall_.settings().timing.start_ns);
    const double centre_x = 45.0 + 500.0 * t_s;
    const double centre_y = 60.0 + 30.0 * std::sin(14.0 * t_s);
    cv::Mat1f image = wall_.irradianceAt(t_ns);
    const cv::Matx23d shift(1.0, 0.0, centre_x - 80.0, 0.0, 1.0, centre_y - 60.0);
    cv::Mat1f disc;
    cv::warpAffine(stones_.irradianceAt(t_ns), disc, shift, image.size(), cv::INTER_LINEAR,
                   cv::BORDER_REFLECT);
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) {
        const double way = std::hypot(x - centre_x, y - centre_y);
        const auto share = static_cast<float>(std::clamp(kRadius_px + 0.5 - way, 0.0, 1.0));
        image(y, x) += share * (disc(y, x) - image(y, x));
      }
    }
    return image;
  }

  DavisSimulator wall_;
  DavisSimulator stones_;
};

/// A sequence, deblurred.
/// \param factor given thresholds over true ones
inline RecordingSink deblur(const SimulatedSequence& sequence, const SimulationSettings& settings,
                            DeblurParameters parameters, double factor = 1.0) {
  parameters.thresholds = {factor * settings.sensor.thresholds.on,
                           factor * settings.sensor.thresholds.off};
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = settings.timing.exposure_us * kNanosecondsPerMicrosecond;
  RecordingSink sink;
  Deblurrer deblurrer(parameters, sink);
  deblurrer.addEvents(sequence.events.data(), sequence.events.size(), kPlaneSize, 0);
  for (const SimulatedFrame& frame : sequence.frames) {
    deblurrer.addFrame(makeFrame(frame.exposure.at(ExposureInstant::kMid), kPlaneSize,
                                 {frame.blurry.datastart, frame.blurry.dataend}),
                       0);
  }
  deblurrer.finish();
  return sink;
}

inline std::vector<std::uint8_t> lastImage(const SimulatedSequence& sequence,
                                           const SimulationSettings& settings, bool reblur,
                                           double factor = 1.0) {
  DeblurParameters parameters;
  parameters.filter.reblur = reblur;
  return deblur(sequence, settings, parameters, factor).outputs.back().pixels;
}

inline double psnrOf(const std::vector<std::uint8_t>& pixels, const cv::Mat& truth) {
  double squares = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    squares += std::pow(static_cast<double>(pixels[i]) - truth.data[i], 2);
  }
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(pixels.size()) / squares);
}

}  // namespace testing
}  // namespace fast_edi
