#include "dark_channel/kernel_estimation.hpp"

#include <gtest/gtest.h>

#include "dark_channel/blurred_textures.hpp"
#include "dark_channel/periodic_image.hpp"

namespace fast_edi {
namespace {

cv::Mat1f withPoint(cv::Mat1f kernel, cv::Point at, float value) {
  kernel(at) = value;
  return kernel;
}

TEST(EstimateKernel, FindsTheKernelBetweenSharpAndBlurry) {
  constexpr int kMargin = 10;
  const cv::Mat sharp = sharpTexture("polygons", 116);
  const cv::Mat blurry = blurredTexture(sharp, shakeKernel(), kMargin);
  cv::Mat1f blurry_image;
  cv::Mat1f sharp_image;
  blurry.convertTo(blurry_image, CV_32F, 1.0 / 255.0);
  sharp(cv::Rect({kMargin, kMargin}, blurry.size())).convertTo(sharp_image, CV_32F, 1.0 / 255.0);
  const cv::Mat1f kernel = estimateKernel(periodicImage(sharp_image, 13),
                                          periodicImage(blurry_image, 13), blurry.size(), 2.0, 13);
  EXPECT_EQ(kernel.size(), cv::Size(13, 13));
  EXPECT_GT(kernelCorrelation(kernel, shakeKernel()), 0.98);
}

TEST(PlausibleKernel, HasNoNegativeWeakOrIsolatedWeights) {
  cv::Mat1f estimate(11, 11, 0.0F);
  estimate(cv::Rect(4, 4, 3, 3)).setTo(1.0F);
  estimate = withPoint(estimate, {5, 3}, -0.5F);
  estimate = withPoint(estimate, {7, 5}, 0.04F);
  estimate = withPoint(estimate, {1, 1}, 0.5F);
  const cv::Mat1f kernel = plausibleKernel(estimate);
  cv::Mat1f expected(11, 11, 0.0F);
  expected(cv::Rect(4, 4, 3, 3)).setTo(1.0F / 9.0F);
  EXPECT_LT(cv::norm(kernel, expected, cv::NORM_INF), 1e-6);
}

TEST(PlausibleKernel, OfManySmallPartsTheLargestStays) {
  cv::Mat1f points(11, 11, 0.0F);
  for (int y = 0; y < 11; y += 2) {
    for (int x = 0; x < 11; x += 2) {
      points(y, x) = 1.0F;
    }
  }
  points(4, 6) = 1.5F;
  const cv::Mat1f kernel = plausibleKernel(points);
  EXPECT_EQ(kernel(5, 5), 1.0F) << "moved to the centre";
  EXPECT_EQ(cv::countNonZero(kernel), 1);
}

TEST(PlausibleKernel, LiesInTheCentreAsFarAsItHasRoom) {
  cv::Mat1f corner(9, 9, 0.0F);
  corner(cv::Rect(0, 6, 3, 3)).setTo(1.0F);
  EXPECT_EQ(plausibleKernel(corner)(4, 4), plausibleKernel(corner)(3, 5));
  EXPECT_GT(plausibleKernel(corner)(3, 3), 0.0F);
  EXPECT_EQ(plausibleKernel(corner)(8, 0), 0.0F);
  cv::Mat1f uneven(1, 9, 0.1F);  // as wide as the kernel: it cannot move
  uneven(0, 8) = 5.0F;
  EXPECT_GT(plausibleKernel(withPoint(uneven, {0, 0}, 1.0F))(0, 8), 0.0F);
}

TEST(PlausibleKernel, IsAPointWhereNothingIsLeft) {
  const cv::Mat1f kernel = plausibleKernel(cv::Mat1f(5, 5, -1.0F));
  EXPECT_EQ(kernel(2, 2), 1.0F);
  EXPECT_EQ(cv::countNonZero(kernel), 1);
}

TEST(EnlargedKernel, SumsUpToOne) {
  const cv::Mat1f kernel = enlargedKernel(shakeKernel(), 13);
  EXPECT_EQ(kernel.size(), cv::Size(13, 13));
  EXPECT_NEAR(cv::sum(kernel)[0], 1.0, 1e-5);
}

}  // namespace
}  // namespace fast_edi
