#include "dark_channel/periodic_image.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(PeriodicImage, KeepsTheImageAndHasNoSeam) {
  cv::Mat1f image(20, 30);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image(y, x) = static_cast<float>(x + 2 * y) / 100.0F;
    }
  }
  constexpr int kMargin = 10;
  const cv::Mat1f periodic = periodicImage(image, kMargin);
  ASSERT_GE(periodic.rows, image.rows + kMargin);
  ASSERT_GE(periodic.cols, image.cols + kMargin);
  EXPECT_EQ(cv::norm(periodic(cv::Rect({0, 0}, image.size())), image, cv::NORM_INF), 0.0);
  // The ramps from the last to the first column (0.29 in 10 px or more) and row (0.38) are even.
  for (int y = 0; y < periodic.rows; ++y) {
    for (int x = 0; x < periodic.cols; ++x) {
      const float value = periodic(y, x);
      EXPECT_LT(std::abs(periodic(y, (x + 1) % periodic.cols) - value), 0.05F) << x << ", " << y;
      EXPECT_LT(std::abs(periodic((y + 1) % periodic.rows, x) - value), 0.05F) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace fast_edi
