#include "scenes/face_renderer.hpp"

#include <numeric>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr PinholeCamera kCamera{{200, 100}, 100.0};
constexpr double kTexelM = 0.01;
constexpr float kLight = 0.5F;

/// A square of 1 m, evenly bright, 2 m before a camera in the origin: 50 px.
TexturedBody square() {
  constexpr int kTexels = 102;
  TexturedFace face{
      {0.0, 0.0, 2.0}, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 1.0, 1.0, {}};
  for (int level = 0; level < kTextureLevels; ++level) {
    const int side = kTexels >> level;
    const float scale = static_cast<float>(side) / kTexels;
    face.levels.push_back({cv::Mat1f(side, side, kLight), scale, scale});
  }
  return {face.centre, {face}};
}

RigidPose poseAt(double x, double y, double z) {
  RigidPose pose;
  pose.position = {x, y, z};
  return pose;
}

class FaceRendererTest : public ::testing::Test {
 protected:
  const TexturedBody body_ = square();
  const FaceRenderer renderer_{kCamera, kTexelM, 1.0};
};

TEST_F(FaceRendererTest, ShowsAFaceWhereItIs) {
  const std::vector<FaceView> views = renderer_.viewsOf(body_, poseAt(0.0, 0.0, 0.0));
  ASSERT_EQ(views.size(), 1u);
  BodyRow row(200);
  row.begin = 200;
  renderer_.drawRow(views[0], 50, row);
  EXPECT_NEAR(std::accumulate(row.cover.begin(), row.cover.end(), 0.0), 50.0, 0.01);
  EXPECT_FLOAT_EQ(row.cover[99], 1.0F);
  EXPECT_FLOAT_EQ(row.light[99], kLight);
  EXPECT_NEAR(row.cover[74], 0.0, 0.01);
  EXPECT_NEAR(row.cover[75], 1.0, 0.01);
  EXPECT_LE(row.begin, 75);
  EXPECT_GE(row.begin, 74);
  EXPECT_GE(row.end, 125);
  EXPECT_LE(row.end, 126);
}

TEST_F(FaceRendererTest, LeavesRowsBesideAFaceUntouched) {
  const std::vector<FaceView> views = renderer_.viewsOf(body_, poseAt(0.0, 0.0, 0.0));
  ASSERT_EQ(views.size(), 1u);
  BodyRow row(200);
  row.begin = 200;
  renderer_.drawRow(views[0], 10, row);
  EXPECT_EQ(row.begin, 200);
  EXPECT_EQ(row.end, 0);
}

TEST_F(FaceRendererTest, ShowsNoFaceFromBehindOrOutOfView) {
  EXPECT_TRUE(renderer_.viewsOf(body_, poseAt(0.0, 0.0, 4.0)).empty());
  EXPECT_TRUE(renderer_.viewsOf(body_, poseAt(5.0, 0.0, 0.0)).empty());
  EXPECT_TRUE(renderer_.viewsOf(body_, poseAt(0.0, -5.0, 0.0)).empty());
}

}  // namespace
}  // namespace fast_edi
