/// \file
/// The simulated room, and what a camera sees of it.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "scenes/face_renderer.hpp"
#include "scenes/pinhole_camera.hpp"
#include "scenes/room_bodies.hpp"
#include "scenes/room_trajectory.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Six textured walls with pillars and boxes before them, seen by a pinhole camera. Faces are drawn
/// by FaceRenderer, with edges as soft as the blur of lens and photodiode area. Furniture is drawn
/// from far to near.
class Room {
 public:
  /// \param focal_length_px the optical axis meets the middle of the image
  /// \throws std::runtime_error when the texture file cannot be read
  Room(const RoomSettings& settings, const SceneSettings& scene, SensorSize view,
       double focal_length_px, std::uint64_t seed);

  /// Irradiance of every pixel, 1 = a white surface at illumination 1.
  /// \param irradiance CV_32FC1, allocated when needed
  void render(const RigidPose& pose, cv::Mat1f& irradiance) const;

  /// Distance along the optical axis of what a pixel sees [m].
  double depthAt(const RigidPose& pose, const cv::Point2d& pixel) const;

  const PinholeCamera& camera() const { return camera_; }

 private:
  PinholeCamera camera_;
  RoomBodies bodies_;
  FaceRenderer renderer_;
};

}  // namespace fast_edi
