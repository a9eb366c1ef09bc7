/// \file
/// Where a tag is, seen from the camera.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace fast_edi {

/// A calibrated camera, in OpenCV's terms.
struct CameraModel {
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  /// Coefficients of OpenCV's model (none, 4, 5, 8, ...), or the four of its fisheye model.
  std::vector<double> distortion;
  bool fisheye = false;
};

/// The tag's frame in the camera's optical frame (x right, y down, z ahead). The tag's frame is
/// that of apriltag_ros: origin in the centre, x to the right and y upwards on the upright tag, z
/// out of the paper.
struct TagPose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// Pose from the four corners of a square, by infinitesimal plane-based pose estimation: T.
/// Collins, A. Bartoli, "Infinitesimal Plane-based Pose Estimation", IJCV 2014. Of the two poses
/// that a square allows, the one whose corners lie closer to those found. \param corners [px], by
/// TagCorner \param side_m distance of two neighbouring corners \return nothing when the corners
/// are no view of a square before the camera
std::optional<TagPose> estimateTagPose(const std::array<cv::Point2d, 4>& corners, double side_m,
                                       const CameraModel& camera);

}  // namespace fast_edi
