#include "fast_edi/tags/tag_pose.hpp"

#include <opencv2/calib3d.hpp>

#include "fast_edi/tags/tag_detector.hpp"

namespace fast_edi {
namespace {

/// Corners on the plane at distance 1 before a camera without distortion, in the order that
/// SOLVEPNP_IPPE_SQUARE asks for: clockwise from the top left.
std::vector<cv::Point2d> normalized(const std::array<cv::Point2d, 4>& corners,
                                    const CameraModel& camera) {
  const std::vector<cv::Point2d> found = {corners[kTopLeft], corners[kTopRight],
                                          corners[kBottomRight], corners[kBottomLeft]};
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
  const double half = 0.5 * side_m;
  const std::vector<cv::Point3d> square = {
      {-half, half, 0.0}, {half, half, 0.0}, {half, -half, 0.0}, {-half, -half, 0.0}};
  cv::Vec3d rotation;
  cv::Vec3d translation;
  if (!cv::solvePnP(square, normalized(corners, camera), cv::Matx33d::eye(), cv::noArray(),
                    rotation, translation, false, cv::SOLVEPNP_IPPE_SQUARE)) {
    return std::nullopt;
  }
  TagPose pose;
  pose.position_m = {translation[0], translation[1], translation[2]};
  const Eigen::Vector3d axis(rotation[0], rotation[1], rotation[2]);
  const double angle_rad = axis.norm();
  if (angle_rad > 0.0) {
    pose.orientation = Eigen::AngleAxisd(angle_rad, axis / angle_rad);
  }
  if (!pose.position_m.allFinite() || !pose.orientation.coeffs().allFinite() ||
      pose.position_m.z() <= 0.0) {
    return std::nullopt;
  }
  return pose;
}

}  // namespace fast_edi
