#include "scenes/simulation_settings.hpp"

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace fast_edi {
namespace {

constexpr double kFocalLengthPerWidth = 0.95;
/// A wide lens, as visual odometry wants it.
constexpr double kRoomFocalLengthPerWidth = 0.7;
constexpr int kMinSide = 16;
constexpr int kMaxSide = 4096;
/// ln(D) / D, the slope of the linear part, is above 0 only for D > 1.
constexpr double kLeastLinearBelowDn = 2.0;

constexpr std::array<std::pair<const char*, SceneKind>, 2> kScenes{
    {{"plane", SceneKind::kPlane}, {"room", SceneKind::kRoom}}};
constexpr std::array<std::pair<const char*, TextureKind>, 8> kTextures{
    {{"poster", TextureKind::kPoster},
     {"natural", TextureKind::kNatural},
     {"flat", TextureKind::kFlat},
     {"mosaic", TextureKind::kMosaic},
     {"page", TextureKind::kPage},
     {"clouds", TextureKind::kClouds},
     {"facade", TextureKind::kFacade},
     {"weave", TextureKind::kWeave}}};
constexpr std::array<std::pair<const char*, MotionKind>, 5> kMotions{
    {{"still", MotionKind::kStill},
     {"mild", MotionKind::kMild},
     {"pan", MotionKind::kPan},
     {"spin", MotionKind::kSpin},
     {"shake", MotionKind::kShake}}};

constexpr std::array<std::pair<const char*, HotPixelShape>, 5> kHotPixelShapes{
    {{"single", HotPixelShape::kSingle},
     {"pair", HotPixelShape::kPair},
     {"block", HotPixelShape::kBlock},
     {"row", HotPixelShape::kRow},
     {"column", HotPixelShape::kColumn}}};

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

void checkRoom(const RoomSettings& room) {
  checkRange("room length [m]", room.length_m, 5.0, 50.0);
  checkRange("room width [m]", room.width_m, 5.0, 50.0);
  checkRange("room height [m]", room.height_m, 2.5, 20.0);
  checkRange("texel [m]", room.texel_m, 1e-3, 0.1);
  checkRange("poster pixel [m]", room.poster_px_m, 1e-3, 0.1);
  checkRange("lap [s]", room.lap_s, 10.0, 1e4);
  checkRange("gentle start [s]", room.gentle_s, 0.0, 1e4);
  checkRange("shaking [deg rms]", room.shake_rms_deg, 0.0, 10.0);
  checkRange("shaking [Hz]", room.shake_hz, 0.5, 20.0);
  checkRange("wander", room.wander, 0.0, 1.5);
}

void checkImu(const ImuSettings& imu) {
  checkRange("IMU rate [Hz]", imu.rate_hz, 1.0, 1e4);
  checkRange("accelerometer noise [m/s^2/sqrt(Hz)]", imu.accelerometer_noise, 0.0, 10.0);
  checkRange("gyroscope noise [rad/s/sqrt(Hz)]", imu.gyroscope_noise, 0.0, 10.0);
  checkRange("accelerometer walk [m/s^3/sqrt(Hz)]", imu.accelerometer_walk, 0.0, 10.0);
  checkRange("gyroscope walk [rad/s^2/sqrt(Hz)]", imu.gyroscope_walk, 0.0, 10.0);
  checkRange("accelerometer bias [m/s^2]", imu.accelerometer_bias, 0.0, 10.0);
  checkRange("gyroscope bias [rad/s]", imu.gyroscope_bias, 0.0, 10.0);
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
  settings.linear_below_dn = 0.0;
  settings.delay_us = 0;
  settings.hot_pixel_fraction = 0.0;
  settings.random_initial_level = false;
  settings.read_noise_dn = 0.0;
  settings.electrons_per_dn = 0.0;
  return settings;
}

double SimulationSettings::focalLengthPx() const {
  if (motion.focal_length_px > 0.0) return motion.focal_length_px;
  return sensor.size.width *
         (kind == SceneKind::kRoom ? kRoomFocalLengthPerWidth : kFocalLengthPerWidth);
}

std::int64_t SimulationSettings::lengthNs() const {
  return (2 * timing.lead_us + timing.frames * timing.period_us) * kNanosecondsPerMicrosecond;
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
  checkRange("linear below [DN]", sensor.linear_below_dn, 0.0, 250.0);
  if (sensor.linear_below_dn > 0.0 && sensor.linear_below_dn < kLeastLinearBelowDn) {
    throw std::invalid_argument("linear below [DN]: expected 0, or 2 to 250");
  }
  checkRange("event delay [us]", static_cast<double>(sensor.delay_us), 0.0, 20'000.0);
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
  checkRange("contrast", scene.contrast, 0.0, 2.0);
  checkRange("lamps", scene.lamps, 0, 20);
  checkRange("lamp radiance", scene.lamp_radiance, 0.0, 1000.0);
  checkRange("lamp radius [px]", scene.lamp_radius_px, 1.0, 100.0);
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
  checkRange("exposure swing [relative]", timing.exposure_swing, 0.0, 0.9);
  checkRange("longest exposure [us]",
             static_cast<double>(timing.exposure_us) * (1.0 + timing.exposure_swing), 1.0,
             static_cast<double>(timing.period_us));
  checkRange("lead [us]", static_cast<double>(timing.lead_us), 0.0, 1e7);
  if (timing.start_ns < 0 || timing.start_ns % kNanosecondsPerMicrosecond != 0) {
    throw std::invalid_argument("start [ns]: expected a multiple of 1000, at least 0, got " +
                                std::to_string(timing.start_ns));
  }
  checkRange("motion per step [px]", max_step_px, 0.01, 1.0);
  checkRange("time per step [us]", static_cast<double>(max_step_us), 1.0, 1e5);
  if (kind == SceneKind::kRoom) {
    checkRoom(room);
    checkImu(imu);
    checkRange("tags in the room", scene.tags, 0, 0);
    checkRange("flicker frequency in the room [Hz]", scene.flicker_hz, 0.0, 0.0);
    if (sensor.colour_filter != ColourFilter::kNone) {
      throw std::invalid_argument("room: expected a sensor without colour filter");
    }
  }
}

SceneKind sceneKindFromName(const std::string& name) {
  return fromName("scene", name, kScenes);
}

std::int64_t TimingSettings::exposureUs(int i) const {
  constexpr double kFramesPerSwing = 7.0;
  constexpr double kTurn_rad = 6.283185307179586;
  const double swing = exposure_swing * std::sin(kTurn_rad * i / kFramesPerSwing);
  return static_cast<std::int64_t>(static_cast<double>(exposure_us) * (1.0 + swing));
}

TextureKind textureKindFromName(const std::string& name) {
  return fromName("texture", name, kTextures);
}

HotPixelShape hotPixelShapeFromName(const std::string& name) {
  return fromName("hot pixel shape", name, kHotPixelShapes);
}

MotionKind motionKindFromName(const std::string& name) {
  return fromName("motion", name, kMotions);
}

}  // namespace fast_edi
