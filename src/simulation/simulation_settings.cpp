#include "fast_edi/simulation/simulation_settings.hpp"

#include <array>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace fast_edi {
namespace {

constexpr double kFocalLengthPerWidth = 0.95;
constexpr int kMinSide = 16;
constexpr int kMaxSide = 4096;

constexpr std::array<std::pair<const char*, TextureKind>, 3> kTextures{
    {{"poster", TextureKind::kPoster},
     {"natural", TextureKind::kNatural},
     {"flat", TextureKind::kFlat}}};
constexpr std::array<std::pair<const char*, MotionKind>, 5> kMotions{
    {{"still", MotionKind::kStill},
     {"mild", MotionKind::kMild},
     {"pan", MotionKind::kPan},
     {"spin", MotionKind::kSpin},
     {"shake", MotionKind::kShake}}};

template <typename Names>
auto fromName(const char* what, const std::string& name, const Names& names) {
  std::string known;
  for (const auto& entry : names) {
    if (name == entry.first) return entry.second;
    known += known.empty() ? entry.first : std::string(", ") + entry.first;
  }
  throw std::invalid_argument(std::string(what) + ": expected one of " + known + ", got \"" + name +
                              "\"");
}

/// Written so that NaN is out of range too.
void checkRange(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream message;
  message << name << ": expected " << low << " to " << high << ", got " << value;
  throw std::invalid_argument(message.str());
}

}  // namespace

SensorSettings SensorSettings::ideal() {
  SensorSettings settings;
  settings.threshold_mismatch = 0.0;
  settings.refractory_ns = 0;
  settings.leak_rate_hz = 0.0;
  settings.shot_noise_bright_hz = 0.0;
  settings.shot_noise_dark_hz = 0.0;
  settings.photoreceptor_bright_hz = 0.0;
  settings.photoreceptor_dark_hz = 0.0;
  settings.hot_pixel_fraction = 0.0;
  settings.random_initial_level = false;
  settings.read_noise_dn = 0.0;
  settings.electrons_per_dn = 0.0;
  return settings;
}

double SimulationSettings::focalLengthPx() const {
  return motion.focal_length_px > 0.0 ? motion.focal_length_px
                                      : kFocalLengthPerWidth * sensor.size.width;
}

void SimulationSettings::validate() const {
  checkRange("sensor width [px]", sensor.size.width, kMinSide, kMaxSide);
  checkRange("sensor height [px]", sensor.size.height, kMinSide, kMaxSide);
  checkRange("ON threshold [natural log]", sensor.thresholds.on, 0.01, 10.0);
  checkRange("OFF threshold [natural log]", sensor.thresholds.off, 0.01, 10.0);
  checkRange("threshold mismatch [relative]", sensor.threshold_mismatch, 0.0, 0.5);
  checkRange("refractory period [ns]", static_cast<double>(sensor.refractory_ns), 0.0, 1e9);
  checkRange("leak rate [Hz]", sensor.leak_rate_hz, 0.0, 1e5);
  checkRange("shot noise, bright [Hz]", sensor.shot_noise_bright_hz, 0.0, 1e5);
  checkRange("shot noise, dark [Hz]", sensor.shot_noise_dark_hz, 0.0, 1e5);
  checkRange("photoreceptor cut-off, bright [Hz]", sensor.photoreceptor_bright_hz, 0.0, 1e5);
  checkRange("photoreceptor cut-off, dark [Hz]", sensor.photoreceptor_dark_hz, 0.0, 1e5);
  if ((sensor.photoreceptor_bright_hz > 0.0) != (sensor.photoreceptor_dark_hz > 0.0)) {
    throw std::invalid_argument(
        "photoreceptor cut-off: expected bright and dark both 0 or both above 0 Hz");
  }
  checkRange("event clock [us]", static_cast<double>(sensor.clock_us), 1.0, 1000.0);
  checkRange("hot pixel fraction", sensor.hot_pixel_fraction, 0.0, 1.0);
  checkRange("hot pixel rate [Hz]", sensor.hot_pixel_rate_hz, 0.0, 1e5);
  checkRange("white level [DN]", sensor.white_dn, 1.0, 10000.0);
  checkRange("read noise [DN]", sensor.read_noise_dn, 0.0, 100.0);
  checkRange("electrons per DN", sensor.electrons_per_dn, 0.0, 1e6);
  if (sensor.frame_bits != 8 && sensor.frame_bits != 16) {
    throw std::invalid_argument("frame bits: expected 8 or 16, got " +
                                std::to_string(sensor.frame_bits));
  }
  checkRange("tags", scene.tags, 0, 100);
  checkRange("tag side [px]", scene.tag_side_px, 4.0, 1000.0);
  checkRange("density", scene.density, 0.0, 1.0);
  checkRange("optics sigma [px]", scene.optics_sigma_px, 0.0, 20.0);
  checkRange("illumination", scene.illumination, 1e-4, 100.0);
  checkRange("flicker frequency [Hz]", scene.flicker_hz, 0.0, 1e4);
  checkRange("flicker depth", scene.flicker_depth, 0.0, 0.95);
  checkRange("motion scale", motion.scale, 0.0, 10.0);
  checkRange("focal length [px]", motion.focal_length_px, 0.0, 1e5);
  checkRange("frames", timing.frames, 1, 1'000'000);
  checkRange("period [us]", static_cast<double>(timing.period_us), 100.0, 1e7);
  checkRange("exposure [us]", static_cast<double>(timing.exposure_us), 1.0,
             static_cast<double>(timing.period_us));
  checkRange("lead [us]", static_cast<double>(timing.lead_us), 0.0, 1e7);
  if (timing.start_ns < 0 || timing.start_ns % kNanosecondsPerMicrosecond != 0) {
    throw std::invalid_argument("start [ns]: expected a multiple of 1000, at least 0, got " +
                                std::to_string(timing.start_ns));
  }
  checkRange("motion per step [px]", max_step_px, 0.01, 1.0);
}

TextureKind textureKindFromName(const std::string& name) {
  return fromName("texture", name, kTextures);
}

MotionKind motionKindFromName(const std::string& name) {
  return fromName("motion", name, kMotions);
}

}  // namespace fast_edi
