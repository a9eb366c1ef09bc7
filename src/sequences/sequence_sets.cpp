#include "sequences/sequence_sets.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "scenes/camera_motion.hpp"
#include "sequences/sequence_tables.hpp"
#include "simulation/sensor_models.hpp"

namespace fast_edi {
namespace {

constexpr double kFlickerHz = 100.0;  // lamps on mains of 50 Hz
constexpr double kFlickerDepth = 0.12;
constexpr int kLamps = 4;
constexpr double kHotPixelFraction = 4e-4;
constexpr double kDimBelow = 0.5;
constexpr double kSaturatedAbove = 1.2;
constexpr double kFaintBelow = 0.6;
constexpr double kMildBlurPx = 3.0;
constexpr double kStrongBlurPx = 10.0;
constexpr std::int64_t kUsualPeriodUs = 40'000;
constexpr std::int64_t kShortestPauseUs = 5'000;
constexpr std::int64_t kUsPerMs = 1'000;
constexpr const char* kPhotographPackage = "mate-backgrounds";

/// A camera turns its gain up in dim light: the picture keeps this part of its range at least.
constexpr double kDarkestPicture = 0.5;

void applyLight(double light, SimulationSettings& settings) {
  settings.scene.illumination = light;
  const double gain = std::max(1.0, kDarkestPicture / light);
  settings.sensor.white_dn *= gain;
  settings.sensor.electrons_per_dn /= gain;
}

void applyExtra(SequenceExtra extra, SimulationSettings& settings) {
  SensorSettings& sensor = settings.sensor;
  switch (extra) {
    case SequenceExtra::kNone:
      return;
    case SequenceExtra::kHotPairs:
      sensor.hot_pixel_shape = HotPixelShape::kPair;
      break;
    case SequenceExtra::kHotBlocks:
      sensor.hot_pixel_shape = HotPixelShape::kBlock;
      break;
    case SequenceExtra::kHotRows:
      sensor.hot_pixel_shape = HotPixelShape::kRow;
      break;
    case SequenceExtra::kHotColumn:
      sensor.hot_pixel_shape = HotPixelShape::kColumn;
      // One column in the mean of an array.
      sensor.hot_pixel_fraction = 1.0 / sensor.size.width;
      return;
    case SequenceExtra::kLamps:
      settings.scene.lamps = kLamps;
      settings.scene.flicker_hz = kFlickerHz;
      settings.scene.flicker_depth = kFlickerDepth;
      return;
  }
  sensor.hot_pixel_fraction = kHotPixelFraction;
}

SimulationSettings settingsOf(const SequenceRow& row, int frames, std::uint64_t seed) {
  SimulationSettings settings;
  settings.sensor = sensorModel(row.sensor);
  settings.sensor.size = row.size;
  settings.sensor.thresholds = row.thresholds;
  settings.sensor.delay_us = row.delay_us;
  settings.sensor.read_noise_dn *= row.frame_noise;
  settings.scene.texture = row.texture;
  settings.scene.contrast = row.contrast;
  settings.motion.kind = row.motion;
  settings.motion.scale = row.motion_scale;
  settings.timing.frames = frames;
  settings.timing.exposure_us = row.exposure_ms * kUsPerMs;
  settings.timing.period_us =
      std::max(kUsualPeriodUs, settings.timing.exposure_us + kShortestPauseUs);
  settings.seed = seed;
  applyLight(row.light, settings);
  applyExtra(row.extra, settings);
  return settings;
}

/// Mean over the exposures of the path of the view's fastest corner.
double blurPx(const SimulationSettings& settings) {
  const CameraMotion motion(settings.motion, settings.sensor.size, settings.focalLengthPx(),
                            settings.seed);
  const TimingSettings& timing = settings.timing;
  double sum = 0.0;
  for (int i = 0; i < timing.frames; ++i) {
    const std::int64_t start = (timing.lead_us + i * timing.period_us) * kNanosecondsPerMicrosecond;
    const std::int64_t end = start + timing.exposure_us * kNanosecondsPerMicrosecond;
    for (std::int64_t t = start; t < end; t += kNanosecondsPerMillisecond) {
      sum += motion.displacementPx(t, std::min(end, t + kNanosecondsPerMillisecond));
    }
  }
  return sum / timing.frames;
}

std::string blurName(double px) {
  if (px < kMildBlurPx) return "< 3 px";
  return px <= kStrongBlurPx ? "3-10 px" : "> 10 px";
}

std::string lightName(const SequenceRow& row) {
  if (row.light < kDimBelow) return "dim";
  return row.light > kSaturatedAbove ? "saturated" : "bright";
}

std::string sensorName(const SequenceRow& row) {
  if (row.extra == SequenceExtra::kLamps) return "flicker";
  if (row.extra != SequenceExtra::kNone) return "hot";
  return row.delay_us > 0 ? "delay" : row.sensor;
}

}  // namespace

SequenceSet sequenceSetFromName(const std::string& name) {
  if (name == "twelve") return SequenceSet::kTwelve;
  if (name == "choosing") return SequenceSet::kChoosing;
  if (name == "judging") return SequenceSet::kJudging;
  throw std::invalid_argument("sequences: expected twelve, choosing or judging, got \"" + name +
                              "\"");
}

SequenceSetContents sequencesOf(SequenceSet set, int frames, const std::string& photographs) {
  if (set == SequenceSet::kTwelve || frames < 1) {
    throw std::invalid_argument("sequences: expected choosing or judging, and at least one frame");
  }
  const bool choosing = set == SequenceSet::kChoosing;
  const std::vector<SequenceRow> rows = choosing ? choosingRows() : judgingRows();
  std::uint64_t seed = choosing ? kFirstChoosingSeed : kFirstJudgingSeed;
  SequenceSetContents contents;
  for (const SequenceRow& row : rows) {
    SetSequence entry;
    entry.sequence.name = row.name;
    entry.sequence.for_tuning = choosing;
    entry.sequence.settings = settingsOf(row, frames, seed++);
    entry.threshold_factor = row.threshold_factor;
    const SimulationSettings& settings = entry.sequence.settings;
    entry.factors = {sensorName(row), blurName(blurPx(settings)), lightName(row),
                     row.contrast < kFaintBelow ? "faint" : "full",
                     row.threshold_factor == 1.0 ? "right" : "wrong"};
    if (row.photograph != nullptr) {
      const std::filesystem::path file = std::filesystem::path(photographs) / row.photograph;
      if (!std::filesystem::exists(file)) {
        contents.missing.push_back(std::string(row.name) + ": no " + file.string() +
                                   " (Debian's package " + kPhotographPackage + ")");
        continue;
      }
      entry.sequence.settings.scene.texture_file = file.string();
    }
    contents.sequences.push_back(entry);
  }
  return contents;
}

}  // namespace fast_edi
