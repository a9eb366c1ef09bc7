#include "scenes/room_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include "scenes/jet.hpp"
#include "scenes/random.hpp"

namespace fast_edi {
namespace {

constexpr double kTurnRad = 2.0 * EIGEN_PI;
/// From the middle of the lap's path to the walls there stay this much for wandering and furniture.
constexpr double kClearanceM = 2.0;
constexpr double kEyeLevelPerHeight = 0.5;
constexpr double kWalkRampS = 2.0;
constexpr double kShakeRampS = 1.5;
/// A hand shakes the camera about the wrist.
constexpr double kLeverM = 0.1;
/// A hand rolls the camera less than it turns it.
constexpr double kRollPerShake = 0.6;

struct Band {
  int axis;  ///< x, y, z, heading, pitch, roll
  double amplitude;
  double low_hz;
  double high_hz;
};

/// Walking and looking about [m], [rad].
constexpr std::array<Band, 15> kWalking{{
    {0, 0.12, 0.20, 0.35},
    {0, 0.06, 0.50, 0.80},
    {0, 0.015, 1.6, 2.0},  //
    {1, 0.12, 0.20, 0.35},
    {1, 0.06, 0.50, 0.80},
    {1, 0.015, 1.6, 2.0},  //
    {2, 0.15, 0.20, 0.40},
    {2, 0.05, 0.60, 0.90},
    {2, 0.020, 1.7, 2.1},  //
    {3, 0.25, 0.10, 0.20},
    {3, 0.06, 0.50, 0.90},  //
    {4, 0.10, 0.15, 0.30},
    {4, 0.04, 0.50, 0.90},  //
    {5, 0.05, 0.20, 0.40},
    {5, 0.02, 0.60, 1.00},
}};

/// Part of the shaking: amplitude and frequency relative to the strongest and to the mean.
struct ShakeBand {
  double amplitude;
  double low;
  double high;
};
constexpr std::array<ShakeBand, 3> kShaking{{{1.0, 0.95, 1.1}, {0.8, 0.75, 0.9}, {0.5, 1.2, 1.4}}};

/// Rises from 0 at \p t = 0 to 1 at 1 with two continuous derivatives (Perlin's quintic).
double rise(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * x * (x * (6.0 * x - 15.0) + 10.0);
}

/// The same in time, over \p ramp_s from \p from_s.
Jet riseAt(double t_s, double from_s, double ramp_s) {
  const double x = std::clamp((t_s - from_s) / ramp_s, 0.0, 1.0);
  const double y = 1.0 - x;
  return {rise(x), 30.0 * x * x * y * y / ramp_s,
          60.0 * x * y * (1.0 - 2.0 * x) / (ramp_s * ramp_s)};
}

/// 0 at both ends and `rest_s` inwards, 1 in between.
Jet window(double t_s, double length_s, double rest_s, double ramp_s) {
  Jet fall = riseAt(length_s - t_s, rest_s, ramp_s);
  fall.first = -fall.first;
  return riseAt(t_s, rest_s, ramp_s) * fall;
}

/// Distance at a speed that rises to 1 over the ramp and falls to 0 before the end, divided by the
/// whole distance: from 0 to 1.
/// \pre length_s is at least two ramps
Jet travelled(double t_s, double length_s, double ramp_s) {
  // Integral of rise(); a half at 1.
  const auto risen = [](double x) { return x * x * x * x * (x * (x - 3.0) + 2.5); };
  const double whole = length_s - ramp_s;
  const double from_end_s = length_s - t_s;
  Jet distance;
  if (t_s < ramp_s) {
    distance = {ramp_s * risen(std::max(0.0, t_s) / ramp_s), 0.0, 0.0};
  } else if (from_end_s < ramp_s) {
    distance = {whole - ramp_s * risen(std::max(0.0, from_end_s) / ramp_s), 0.0, 0.0};
  } else {
    distance = {t_s - 0.5 * ramp_s, 0.0, 0.0};
  }
  const Jet speed = window(t_s, length_s, 0.0, ramp_s);
  distance.first = speed.value;
  distance.second = speed.first;
  return (1.0 / whole) * distance;
}

template <typename Waves>
Jet sum(const Waves& waves, double t_s) {
  Jet value;
  for (const auto& wave : waves) {
    const double rate = kTurnRad * wave.frequency_hz;
    value = value + wave.amplitude * sin(Jet{rate * t_s + wave.phase_rad, rate, 0.0});
  }
  return value;
}

}  // namespace

RoomTrajectory::RoomTrajectory(const RoomSettings& settings, std::int64_t length_ns,
                               std::uint64_t seed)
    : length_s_(static_cast<double>(length_ns) / static_cast<double>(kNanosecondsPerSecond)),
      // Short recordings are for trying things out: they are shaken all the same.
      gentle_s_(std::min(settings.gentle_s, length_s_ / 4.0)),
      shake_ramp_s_(std::min(kShakeRampS, length_s_ / 8.0)),
      radius_x_m_(0.5 * settings.length_m - kClearanceM),
      radius_y_m_(0.5 * settings.width_m - kClearanceM),
      height_m_(kEyeLevelPerHeight * settings.height_m) {
  RandomEngine random = makeRandomEngine(seed, RandomStream::kRoomMotion);
  const auto uniform = [&random](double low, double high) {
    return boost::random::uniform_real_distribution<double>(low, high)(random);
  };
  first_angle_rad_ = uniform(0.0, kTurnRad);
  const bool left = boost::random::uniform_int_distribution<int>(0, 1)(random) == 0;
  lap_angle_rad_ = kTurnRad * std::round(length_s_ / settings.lap_s) * (left ? 1.0 : -1.0);

  for (const Band& band : kWalking) {
    const double frequency_hz = uniform(band.low_hz, band.high_hz);
    const double phase_rad = uniform(0.0, kTurnRad);
    walking_[static_cast<std::size_t>(band.axis)].push_back(
        {settings.wander * band.amplitude, frequency_hz, phase_rad});
  }
  double variance = 0.0;
  for (const ShakeBand& band : kShaking) variance += 0.5 * band.amplitude * band.amplitude;
  const double rms_rad = settings.shake_rms_deg * EIGEN_PI / 180.0;
  for (int axis = 0; axis < kAxes; ++axis) {
    const double rms = axis < kHeading ? kLeverM * rms_rad
                       : axis == kRoll ? kRollPerShake * rms_rad
                                       : rms_rad;
    for (const ShakeBand& band : kShaking) {
      const double frequency_hz = settings.shake_hz * uniform(band.low, band.high);
      const double phase_rad = uniform(0.0, kTurnRad);
      shaking_[static_cast<std::size_t>(axis)].push_back(
          {rms * band.amplitude / std::sqrt(variance), frequency_hz, phase_rad});
    }
  }
}

RigidMotion RoomTrajectory::motionAt(std::int64_t t_ns) const {
  const double t_s = std::clamp(
      static_cast<double>(t_ns) / static_cast<double>(kNanosecondsPerSecond), 0.0, length_s_);
  const Jet walk = window(t_s, length_s_, 0.0, kWalkRampS);
  const Jet shake = window(t_s, length_s_, gentle_s_, shake_ramp_s_);
  std::array<Jet, kAxes> axes;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    axes[axis] = walk * sum(walking_[axis], t_s) + shake * sum(shaking_[axis], t_s);
  }
  Jet angle{first_angle_rad_, 0.0, 0.0};
  if (lap_angle_rad_ != 0.0) {
    angle = angle + lap_angle_rad_ * travelled(t_s, length_s_, kWalkRampS);
  }
  axes[kX] = axes[kX] + radius_x_m_ * cos(angle);
  axes[kY] = axes[kY] + radius_y_m_ * sin(angle);
  axes[kZ].value += height_m_;
  axes[kHeading] = axes[kHeading] + angle;

  RigidMotion motion;
  for (int i = 0; i < 3; ++i) {
    const Jet& axis = axes[static_cast<std::size_t>(i)];
    motion.pose.position[i] = axis.value;
    motion.velocity[i] = axis.first;
    motion.acceleration[i] = axis.second;
  }
  // Heading about the world's vertical, then pitch and roll about the camera's own axes. At heading
  // 0 the camera looks along x: right = -y, down = -z.
  Eigen::Matrix3d level;
  level << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  const Eigen::AngleAxisd heading(axes[kHeading].value, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd pitch(axes[kPitch].value, Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd roll(axes[kRoll].value, Eigen::Vector3d::UnitZ());
  motion.pose.orientation = Eigen::Quaterniond(heading) * Eigen::Quaterniond(level) *
                            Eigen::Quaterniond(pitch) * Eigen::Quaterniond(roll);
  // The rates, each about its axis in the camera's frame; up is -y in the levelled camera.
  const Eigen::Vector3d turning =
      pitch.inverse() * Eigen::Vector3d(0.0, -axes[kHeading].first, 0.0) +
      Eigen::Vector3d(axes[kPitch].first, 0.0, 0.0);
  motion.angular_velocity = roll.inverse() * turning + Eigen::Vector3d(0.0, 0.0, axes[kRoll].first);
  return motion;
}

}  // namespace fast_edi
