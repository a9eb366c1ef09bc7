/// \file
/// The simulated inertial sensor.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "scenes/random.hpp"
#include "scenes/room_trajectory.hpp"

namespace fast_edi {

/// Strength of gravity, along -z of the world [m/s^2]: the value that VINS-Mono's configurations
/// use. Standard gravity, 9.80665, is something else: the unit in which recordings count.
constexpr double kGravity = 9.81;

/// One reading, in the camera's optical frame. At rest with a level camera the acceleration is
/// (0, -9.81, 0): the sensor feels what holds it up (REP 145).
struct ImuSample {
  std::int64_t t_ns = 0;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();     ///< [rad/s]
  Eigen::Vector3d linear_acceleration = Eigen::Vector3d::Zero();  ///< specific force [m/s^2]
};

/// What an ideal sensor reads at an instant.
ImuSample idealImuSample(const RigidMotion& motion, std::int64_t t_ns);

/// Adds to ideal readings white noise and biases that walk at random.
class ImuSensor {
 public:
  ImuSensor(const ImuSettings& settings, std::int64_t start_ns, std::uint64_t seed);

  /// Appends the readings of instants up to and with \p t_ns that have not been taken; the first is
  /// that of the start.
  void advance(std::int64_t t_ns, const RoomTrajectory& trajectory,
               std::vector<ImuSample>& samples);

 private:
  Eigen::Vector3d normal(double deviation);

  ImuSettings settings_;
  std::int64_t start_ns_;
  std::int64_t taken_ = 0;
  RandomEngine random_;
  Eigen::Vector3d gyroscope_bias_;
  Eigen::Vector3d accelerometer_bias_;
};

}  // namespace fast_edi
