/// \file
/// The camera's path over the plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/base/types.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Pinhole camera over the plane z = 0, looking along z; the nominal pose is all zero.
struct CameraPose {
  double x_px = 0.0;  ///< sideways [px of the nominal view]
  double y_px = 0.0;
  double height = 0.0;     ///< relative to the nominal distance: 0.1 = 10 % farther away
  double yaw_rad = 0.0;    ///< about the image's y axis
  double pitch_rad = 0.0;  ///< about the image's x axis
  double roll_rad = 0.0;   ///< about the optical axis
};

/// A seeded trajectory: each degree of freedom is a sum of sinusoids.
class CameraMotion {
 public:
  CameraMotion(const MotionSettings& settings, SensorSize size, double focal_length_px,
               std::uint64_t seed);

  /// \param t_ns time since the recording's start
  CameraPose poseAt(std::int64_t t_ns) const;
  /// Homography from homogeneous pixel coordinates (origin: centre of the top left pixel) to plane
  /// coordinates [px of the nominal view, origin in its centre].
  cv::Matx33d imageToPlaneAt(std::int64_t t_ns) const;
  /// Largest way that a corner or the centre of the image moves between two instants [px].
  double displacementPx(std::int64_t from_ns, std::int64_t to_ns) const;
  /// The same as speed at an instant [px/s].
  double speedPxPerSecond(std::int64_t t_ns) const;

 private:
  struct Wave {
    double amplitude;
    double frequency_hz;
    double phase_rad;
  };
  static constexpr int kAxes = 6;

  double sum(int axis, double t_s) const;

  SensorSize size_;
  double focal_length_px_;
  std::array<std::vector<Wave>, kAxes> waves_;
};

}  // namespace fast_edi
