#include "sequences/sequences.hpp"

#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "sequences/sequence_input.hpp"
#include "simulation/davis_simulator.hpp"

namespace fast_edi {
namespace {

struct NamedScene {
  const char* name;
  bool for_tuning;
  TextureKind texture;
  double density;
  int tags;
  MotionKind motion;
  double illumination;
  std::int64_t exposure_us;
};

constexpr double kBright = 1.0;
constexpr double kDim = 0.25;
constexpr double kDimGain = 2.0;
constexpr double kDimReadNoiseDn = 2.0;
constexpr std::int64_t kPeriodUs = 40'000;

constexpr std::array<NamedScene, 6> kScenes = {{
    {"poster-strong", true, TextureKind::kPoster, 0.6, 6, MotionKind::kShake, kBright, 30'000},
    {"poster-mild-dim", true, TextureKind::kPoster, 0.6, 6, MotionKind::kMild, kDim, 25'000},
    {"sparse-sweep", true, TextureKind::kPoster, 0.1, 2, MotionKind::kPan, kBright, 25'000},
    {"mosaic-strong-dim", false, TextureKind::kMosaic, 0.0, 6, MotionKind::kShake, kDim, 30'000},
    {"mosaic-mild", false, TextureKind::kMosaic, 0.0, 6, MotionKind::kMild, kBright, 20'000},
    {"page-spin", false, TextureKind::kPage, 0.0, 2, MotionKind::kSpin, kBright, 20'000},
}};

SimulationSettings settingsOf(const NamedScene& scene, int frames, std::uint64_t seed) {
  SimulationSettings settings;
  settings.scene.texture = scene.texture;
  settings.scene.density = scene.density;
  settings.scene.tags = scene.tags;
  settings.scene.illumination = scene.illumination;
  settings.motion.kind = scene.motion;
  if (scene.illumination < kBright) {
    // The camera's gain is turned up: twice the DN for the same electrons.
    settings.sensor.white_dn *= kDimGain;
    settings.sensor.electrons_per_dn /= kDimGain;
    settings.sensor.read_noise_dn = kDimReadNoiseDn;
  }
  settings.sensor.photoreceptor_bright_hz = 300.0;
  settings.sensor.photoreceptor_dark_hz = 30.0;
  settings.timing.frames = frames;
  settings.timing.period_us = kPeriodUs;
  settings.timing.exposure_us = scene.exposure_us;
  settings.seed = seed;
  return settings;
}

}  // namespace

std::vector<EvaluationSequence> evaluationSequences(int frames, int seeds) {
  if (frames < 1 || seeds < 1) {
    throw std::invalid_argument("sequences: expected at least one frame and one seed, got " +
                                std::to_string(frames) + " and " + std::to_string(seeds));
  }
  std::vector<EvaluationSequence> sequences;
  for (const NamedScene& scene : kScenes) {
    for (int seed = 1; seed <= seeds; ++seed) {
      sequences.push_back({std::string(scene.name) + "/" + std::to_string(seed), scene.for_tuning,
                           settingsOf(scene, frames, static_cast<std::uint64_t>(seed))});
    }
  }
  return sequences;
}

Evaluation evaluateSequence(const EvaluationSequence& sequence, const DeblurParameters& parameters,
                            double threshold_factor, const ContrastSearchOptions& search,
                            const FrameScorer& scorer, const OtherMethods& others,
                            const std::function<void(int)>& progress) {
  std::map<std::int64_t, cv::Mat> truths;
  int done = 0;
  EvaluationRecorder recorder(
      sequence.name, scorer,
      [&](std::int64_t stamp_ns) {
        const auto found = truths.find(stamp_ns);
        return found != truths.end() ? found->second : cv::Mat();
      },
      others);
  MethodComparison comparison(sensorParameters(parameters, sequence.settings, threshold_factor),
                              search, [&](const ComparedFrame& frame) {
                                recorder.add(frame);
                                truths.erase(truths.begin(), truths.upper_bound(frame.stamp_ns));
                                progress(++done);
                              });

  DavisSimulator simulator(sequence.settings);
  WireArrays arrays;
  SimulatedInterval interval;
  while (simulator.next(interval)) {
    const std::int64_t stamp_ns = interval.frame.exposure.at(ExposureInstant::kMid);
    truths[stamp_ns] = interval.frame.sharp;
    // A frame leaves the camera when its exposure ends, before the last events that cover it.
    comparison.addFrame(stamp_ns, interval.frame.blurry, interval.frame.exposure.end_ns);
    const WireArrays::Array array = arrays.pack(interval.events);
    comparison.addEvents(array.events, sequence.settings.sensor.size, array.sequence,
                         interval.end_ns);
  }
  comparison.finish();
  return recorder.evaluation();
}

}  // namespace fast_edi
