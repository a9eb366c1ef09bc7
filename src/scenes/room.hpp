/// \file
/// The simulated room and its rendering.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "scenes/random.hpp"
#include "scenes/room_trajectory.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Six textured walls with pillars and boxes before them, seen by a pinhole camera without
/// distortion. Every face is a textured rectangle, drawn by its homography. Textures are pyramids
/// already blurred by lens and photodiode area, sampled bilinearly within a level and linearly
/// between levels; edges of faces are softened over the width of that blur, so that irradiance
/// changes smoothly with the pose.
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

  /// Ray through a pixel in the optical frame, of length 1 along the axis.
  Eigen::Vector3d rayOf(const cv::Point2d& pixel) const;
  /// Pixel that sees a point of the optical frame. \pre the point lies before the camera
  cv::Point2d project(const Eigen::Vector3d& point) const;

 private:
  /// A level of a texture's pyramid.
  struct Level {
    cv::Mat1f texels;
    float u_scale = 1.0F;  ///< of texel coordinates against those of the finest level
    float v_scale = 1.0F;
  };
  /// A rectangle, seen from where its normal v x u points to; from there its texture is not
  /// mirrored.
  struct Face {
    Eigen::Vector3d centre;
    Eigen::Vector3d u;  ///< unit vectors along the texture's columns and rows
    Eigen::Vector3d v;
    double width_m;  ///< along u
    double height_m;
    std::vector<Level> levels;
  };
  /// Faces that a convex body shows; of its faces none hides another.
  struct Body {
    Eigen::Vector3d centre;
    std::vector<Face> faces;
  };
  /// A face as a pose sees it: functions that are linear in the pixel's coordinates (x, y, 1).
  struct View;
  /// Scratch for one row of the image.
  struct Row;

  void addWalls(const SceneSettings& scene, RandomEngine& random);
  void addFurniture(const SceneSettings& scene, RandomEngine& random);
  void addFace(const SceneSettings& scene, double poster_px_m, RandomEngine& random, Face face,
               Body& body) const;
  std::vector<View> viewsOf(const Body& body, const RigidPose& pose) const;
  void drawRow(const View& view, int y, Row& row) const;

  RoomSettings settings_;
  SensorSize size_;
  double focal_length_px_;
  double edge_width_px_;
  Body walls_;
  std::vector<Body> furniture_;
};

}  // namespace fast_edi
