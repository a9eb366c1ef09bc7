#include "fast_edi/tags/tag_pose.hpp"

#include <cmath>

#include <opencv2/calib3d.hpp>

#include "fast_edi/tags/tag_detector.hpp"

namespace fast_edi {
namespace {

constexpr double kQuarterTurn_rad = 0.5 * CV_PI;

/// Quarter turns, clockwise, from the upright tag to that seen: 0..3.
int quarterTurns(const std::array<cv::Point2d, 4>& corners) {
  const cv::Point2d rightwards =
      corners[kBottomRight] - corners[kBottomLeft] + corners[kTopRight] - corners[kTopLeft];
  const double quarters = std::atan2(rightwards.y, rightwards.x) / kQuarterTurn_rad;
  return std::isfinite(quarters) ? (static_cast<int>(std::lround(quarters)) + 4) % 4 : 0;
}

/// Corners on the plane at distance 1 before a camera without distortion.
std::vector<cv::Point2d> normalised(const std::vector<cv::Point2d>& found,
                                    const CameraModel& camera) {
  const cv::Matx33d matrix(camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px, camera.cy_px, 0.0,
                           0.0, 1.0);
  std::vector<cv::Point2d> points;
  if (camera.fisheye) {
    cv::fisheye::undistortPoints(found, points, matrix, camera.distortion);
  } else {
    cv::undistortPoints(found, points, matrix, camera.distortion);
  }
  return points;
}

}  // namespace

std::optional<TagPose> estimateTagPose(const std::array<cv::Point2d, 4>& corners, double side_m,
                                       const CameraModel& camera) {
  // Solved as if the tag were upright and its frame's y and z turned over, as near to the camera's
  // axes as can be: OpenCV gives the rotation as a vector, wrongly where it is half a turn.
  const int turns = quarterTurns(corners);
  std::vector<cv::Point2d> found;
  for (int i = 0; i < 4; ++i) {
    found.push_back(corners[static_cast<std::size_t>((i + turns) % 4)]);
  }
  const double half = 0.5 * side_m;
  // In this order and with these signs by the rules of SOLVEPNP_IPPE_SQUARE.
  const std::vector<cv::Point3d> square = {
      {-half, half, 0.0}, {half, half, 0.0}, {half, -half, 0.0}, {-half, -half, 0.0}};
  cv::Vec3d rotation;
  cv::Vec3d translation;
  if (!cv::solvePnP(square, normalised(found, camera), cv::Matx33d::eye(), cv::noArray(), rotation,
                    translation, false, cv::SOLVEPNP_IPPE_SQUARE)) {
    return std::nullopt;
  }
  TagPose pose;
  pose.position_m = {translation[0], translation[1], translation[2]};
  const Eigen::Vector3d axis(rotation[0], rotation[1], rotation[2]);
  const double angle_rad = axis.norm();
  if (angle_rad > 0.0) {
    pose.orientation = Eigen::AngleAxisd(angle_rad, axis / angle_rad);
  }
  pose.orientation = pose.orientation *
                     Eigen::AngleAxisd(turns * kQuarterTurn_rad, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(2.0 * kQuarterTurn_rad, Eigen::Vector3d::UnitX());
  if (!pose.position_m.allFinite() || !pose.orientation.coeffs().allFinite() ||
      pose.position_m.z() <= 0.0) {
    return std::nullopt;
  }
  return pose;
}

}  // namespace fast_edi
