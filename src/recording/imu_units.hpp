/// \file
/// Units of IMU samples in AEDAT files, in those of ROS.
#pragma once

namespace fast_edi {

constexpr double kStandardGravity = 9.80665;  ///< g [m/s^2]
constexpr double kRadiansPerDegree = 0.017453292519943295;

}  // namespace fast_edi
