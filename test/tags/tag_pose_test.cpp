#include "fast_edi/tags/tag_pose.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "fast_edi/tags/tag_detector.hpp"
#include "tags/tag_pictures.hpp"

namespace fast_edi {
namespace {

constexpr double kSide_m = 0.16;

CameraModel davisCamera() {
  CameraModel camera;
  camera.fx_px = 330.0;
  camera.fy_px = 328.0;
  camera.cx_px = 171.5;
  camera.cy_px = 131.0;
  return camera;
}

/// A tag 0.6 m ahead, upright but turned to the left and tilted. The tag's z axis points to the
/// camera, hence the half turn about x.
TagPose knownPose() {
  TagPose pose;
  pose.position_m = {0.05, -0.03, 0.6};
  pose.orientation = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  return pose;
}

std::array<cv::Point2d, 4> projectedCorners(const TagPose& pose, const CameraModel& camera) {
  const double half = 0.5 * kSide_m;
  std::vector<cv::Point3d> points;
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(-half, -half, 0.0), Eigen::Vector3d(half, -half, 0.0),
        Eigen::Vector3d(half, half, 0.0), Eigen::Vector3d(-half, half, 0.0)}) {
    const Eigen::Vector3d seen = pose.orientation * corner + pose.position_m;
    points.emplace_back(seen.x(), seen.y(), seen.z());
  }
  const cv::Matx33d matrix(camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px, camera.cy_px, 0.0,
                           0.0, 1.0);
  const cv::Vec3d none(0.0, 0.0, 0.0);
  std::vector<cv::Point2d> pixels;
  if (camera.fisheye) {
    cv::fisheye::projectPoints(points, pixels, none, none, matrix, camera.distortion);
  } else {
    cv::projectPoints(points, none, none, matrix, camera.distortion, pixels);
  }
  return {pixels[0], pixels[1], pixels[2], pixels[3]};
}

void expectPose(const std::optional<TagPose>& found, const TagPose& expected, double position_m,
                double angle_rad) {
  ASSERT_TRUE(found);
  EXPECT_LT((found->position_m - expected.position_m).norm(), position_m)
      << found->position_m.transpose();
  EXPECT_LT(found->orientation.angularDistance(expected.orientation), angle_rad);
}

TEST(TagPoseTest, FollowsFromTheCorners) {
  const CameraModel camera = davisCamera();
  const auto pose = estimateTagPose(projectedCorners(knownPose(), camera), kSide_m, camera);
  expectPose(pose, knownPose(), 1e-6, 1e-5);
}

TEST(TagPoseTest, HoldsForEachTurnOfTheTag) {
  const CameraModel camera = davisCamera();
  for (int degrees = -180; degrees <= 180; degrees += 15) {
    for (const double tilt_rad : {0.0, 0.4}) {
      TagPose turned = knownPose();
      turned.orientation = Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(degrees * M_PI / 180.0, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
      SCOPED_TRACE(std::to_string(degrees) + " degrees, tilt " + std::to_string(tilt_rad));
      expectPose(estimateTagPose(projectedCorners(turned, camera), kSide_m, camera), turned, 1e-4,
                 1e-3);
    }
  }
}

TEST(TagPoseTest, DistortionIsTakenOut) {
  CameraModel camera = davisCamera();
  camera.distortion = {-0.35, 0.15, 0.001, -0.002, 0.0};
  expectPose(estimateTagPose(projectedCorners(knownPose(), camera), kSide_m, camera), knownPose(),
             1e-3, 1e-2);
  camera.distortion = {-0.05, 0.02, -0.01, 0.003};
  camera.fisheye = true;
  expectPose(estimateTagPose(projectedCorners(knownPose(), camera), kSide_m, camera), knownPose(),
             1e-4, 1e-3);
}

TEST(TagPoseTest, OfADetectedTag) {
  const CameraModel camera = davisCamera();
  const auto tags =
      TagDetector().detect(test::frameWithTag(17, projectedCorners(knownPose(), camera)));
  ASSERT_EQ(tags.size(), 1U);
  expectPose(estimateTagPose(tags[0].corners, kSide_m, camera), knownPose(), 0.006, 0.05);
}

TEST(TagPoseTest, AnUprightTagHasItsXRightItsYUpAndLooksAtTheCamera) {
  const CameraModel camera = davisCamera();
  const auto tags = TagDetector().detect(
      test::frameWithTag(0, test::squareAt({camera.cx_px, camera.cy_px}, 60.0)));
  ASSERT_EQ(tags.size(), 1U);
  const auto pose = estimateTagPose(tags[0].corners, kSide_m, camera);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->position_m.z(), camera.fx_px * kSide_m / 60.0, 0.02);
  EXPECT_GT((pose->orientation * Eigen::Vector3d::UnitX()).x(), 0.95);
  EXPECT_LT((pose->orientation * Eigen::Vector3d::UnitY()).y(), -0.95);
  EXPECT_LT((pose->orientation * Eigen::Vector3d::UnitZ()).z(), -0.95);
}

TEST(TagPoseTest, CornersThatAreNoSquareHaveNone) {
  const cv::Point2d point(100.0, 100.0);
  EXPECT_FALSE(estimateTagPose({point, point, point, point}, kSide_m, davisCamera()));
  const double nan = std::nan("");
  EXPECT_FALSE(estimateTagPose(test::squareAt({nan, nan}, 50.0), kSide_m, davisCamera()));
}

}  // namespace
}  // namespace fast_edi
