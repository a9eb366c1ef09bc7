#include "dark_channel/latent_estimation.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "dark_channel/blurred_textures.hpp"
#include "dark_channel/periodic_image.hpp"

namespace fast_edi {
namespace {

/// As the paper has it: each neighbourhood's darkest pixel in turn.
cv::Mat1f slowThreshold(const cv::Mat1f& image, int patch, double threshold) {
  cv::Mat1f result = image.clone();
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      cv::Point darkest(x, y);
      for (int v = std::max(0, y - patch / 2); v <= std::min(image.rows - 1, y + patch / 2); ++v) {
        for (int u = std::max(0, x - patch / 2); u <= std::min(image.cols - 1, x + patch / 2);
             ++u) {
          if (image(v, u) < image(darkest)) {
            darkest = {u, v};
          }
        }
      }
      if (image(darkest) * image(darkest) < threshold) {
        result(darkest) = 0.0F;
      }
    }
  }
  return result;
}

TEST(DarkChannel, ThresholdIsThatOfEachNeighbourhoodsDarkestPixel) {
  cv::Mat1f image(24, 31);
  cv::RNG random(3);
  random.fill(image, cv::RNG::UNIFORM, 0.0, 1.0);
  for (const int patch : {1, 3, 7}) {
    for (const double threshold : {0.0, 0.01, 0.09}) {
      EXPECT_EQ(cv::norm(withDarkChannelThresholded(image, patch, threshold),
                         slowThreshold(image, patch, threshold), cv::NORM_INF),
                0.0)
          << patch << " px, " << threshold;
    }
  }
}

TEST(DarkChannel, APatchLargerThanTheImageHasOneDarkestPixel) {
  cv::Mat1f image(5, 5, 0.5F);
  image(1, 3) = 0.1F;
  const cv::Mat1f result = withDarkChannelThresholded(image, 35, 0.04);
  EXPECT_EQ(result(1, 3), 0.0F);
  EXPECT_EQ(cv::countNonZero(result), 24);
}

TEST(ThresholdGradient, KeepsWhatIsLargeInEitherDirection) {
  Gradient gradient = {(cv::Mat1f(1, 3) << 0.3F, 0.1F, 0.0F),
                       (cv::Mat1f(1, 3) << 0.0F, 0.1F, -0.3F)};
  thresholdGradient(gradient, 0.05);
  EXPECT_EQ(gradient.x(0, 0), 0.3F);
  EXPECT_EQ(gradient.x(0, 1), 0.0F);
  EXPECT_EQ(gradient.y(0, 1), 0.0F);
  EXPECT_EQ(gradient.y(0, 2), -0.3F);
}

TEST(LatentSolver, SolvesItsEquation) {
  cv::Mat1f blurry(16, 20);
  cv::Mat1f pulled(blurry.size());
  cv::RNG random(5);
  random.fill(blurry, cv::RNG::UNIFORM, 0.0, 1.0);
  random.fill(pulled, cv::RNG::UNIFORM, 0.0, 1.0);
  const cv::Mat1f kernel = shakeKernel();
  constexpr double kAlpha = 0.3;
  constexpr double kBeta = 0.2;
  const cv::Mat1f latent = LatentSolver(blurry, kernel).solve(pulled, kAlpha, kBeta);
  // k^T (k * I - B) + alpha grad^T grad I + beta I = pulled
  const Spectrum transfer = transferFunction(kernel, blurry.size());
  Spectrum product;
  cv::mulSpectrums(transfer, forwardTransform(latent), product, 0);
  const cv::Mat1f residual = inverseTransform(product) - blurry;
  const cv::Mat1f back = inverseTransform(conjugateProduct(transfer, forwardTransform(residual)));
  const cv::Mat1f left = back + kAlpha * adjointGradient(gradientOf(latent)) + kBeta * latent;
  EXPECT_LT(cv::norm(left, pulled, cv::NORM_INF), 1e-4);
}

TEST(EstimateLatent, KnownKernelGivesTheEdgesBack) {
  constexpr int kMargin = 10;
  const cv::Mat sharp = sharpTexture("rectangles", 84);
  const cv::Mat blurry = blurredTexture(sharp, shakeKernel(), kMargin);
  const cv::Mat truth = sharp(cv::Rect({kMargin, kMargin}, blurry.size()));
  cv::Mat1f image;
  blurry.convertTo(image, CV_32F, 1.0 / 255.0);
  LatentWeights weights;
  weights.gradient_penalty_max = 1e3;  // quicker
  for (const double dark : {0.0, 0.004}) {
    weights.dark = dark;
    cv::Mat latent;
    estimateLatent(periodicImage(image, 13), shakeKernel(),
                   weights)(cv::Rect({0, 0}, blurry.size()))
        .convertTo(latent, CV_8U, 255.0);
    EXPECT_GT(psnrAtBestShift(latent, truth, 0), psnrAtBestShift(blurry, truth, 0) + 5.0) << dark;
  }
}

}  // namespace
}  // namespace fast_edi
