/// \file
/// The way of a hand-held camera through the room.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Camera in the world: takes coordinates of the optical frame (x right, y down, z forward) to the
/// world frame (z up) [m].
struct RigidPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Motion at an instant, as an inertial sensor feels it.
struct RigidMotion {
  RigidPose pose;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< world frame [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      ///< world frame [m/s^2]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< optical frame [rad/s]
};

/// A seeded trajectory: laps around the room with the view outwards, on which walking, looking
/// about and shaking lie as sums of sinusoids. Windows with continuous second derivatives let all
/// of it start from rest and end at rest, in the same pose. Twice differentiable; derivatives are
/// exact.
class RoomTrajectory {
 public:
  /// \param length_ns from the start to the end, both at rest
  RoomTrajectory(const RoomSettings& settings, std::int64_t length_ns, std::uint64_t seed);

  /// \param t_ns time since the recording's start; before it and after the end the camera rests
  RigidMotion motionAt(std::int64_t t_ns) const;
  RigidPose poseAt(std::int64_t t_ns) const { return motionAt(t_ns).pose; }

 private:
  enum Axis { kX, kY, kZ, kHeading, kPitch, kRoll, kAxes };
  struct Wave {
    double amplitude;  ///< [m] or [rad]
    double frequency_hz;
    double phase_rad;
  };
  using Waves = std::array<std::vector<Wave>, kAxes>;

  double length_s_;
  double gentle_s_;      ///< without shaking, at each end
  double shake_ramp_s_;  ///< of the shaking
  double radius_x_m_;
  double radius_y_m_;
  double height_m_;
  double first_angle_rad_;  ///< place on the lap at the start
  double lap_angle_rad_;    ///< whole turns, signed
  Waves walking_;
  Waves shaking_;
};

}  // namespace fast_edi
