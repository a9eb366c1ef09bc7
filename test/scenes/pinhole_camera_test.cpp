#include "scenes/pinhole_camera.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr PinholeCamera kCamera{{160, 121}, 100.0};

TEST(PinholeCamera, LooksAlongItsAxisInTheMiddle) {
  EXPECT_EQ(kCamera.rayOf({79.5, 60.0}), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(kCamera.rayOf({179.5, 60.0}), Eigen::Vector3d(1.0, 0.0, 1.0));
}

TEST(PinholeCamera, SeesAPointOfARayInItsPixel) {
  for (const double depth : {0.1, 1.0, 7.0}) {
    const cv::Point2d pixel = kCamera.project(depth * kCamera.rayOf({12.0, 34.5}));
    EXPECT_NEAR(pixel.x, 12.0, 1e-9);
    EXPECT_NEAR(pixel.y, 34.5, 1e-9);
  }
}

}  // namespace
}  // namespace fast_edi
