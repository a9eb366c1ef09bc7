#include "measures/image_metrics.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "evaluation/test_images.hpp"
#include "measures/capability.hpp"

namespace fast_edi {
namespace {

TEST(PsnrTest, IsThatOfAConstantErrorByHand) {
  const cv::Mat truth(8, 10, CV_8UC1, cv::Scalar(100));
  const cv::Mat image(8, 10, CV_8UC1, cv::Scalar(105));
  EXPECT_NEAR(psnr(image, truth), 20.0 * std::log10(255.0 / 5.0), 1e-9);
}

TEST(PsnrTest, IdenticalImagesHaveAFiniteValue) {
  const cv::Mat image = texturedImage();
  EXPECT_EQ(psnr(image, image), kMaxPsnrDb);
}

TEST(PsnrTest, RefusesImagesThatDoNotFit) {
  const cv::Mat image = texturedImage();
  EXPECT_THROW(psnr(image, cv::Mat(3, 3, CV_8UC1)), std::invalid_argument);
  EXPECT_THROW(psnr(image, cv::Mat(image.size(), CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(psnr(cv::Mat(), cv::Mat()), std::invalid_argument);
}

TEST(SsimTest, IsOneForItselfAndFallsWithTheError) {
  const cv::Mat truth = texturedImage();
  if (!isAvailable(OptionalLibrary::kOpencvQuality)) {
    EXPECT_THROW(ssim(truth, truth), UnavailableError);
    return;
  }
  EXPECT_NEAR(ssim(truth, truth), 1.0, 1e-6);
  const double slight = ssim(withNoise(truth, 3.0), truth);
  const double strong = ssim(withNoise(truth, 20.0), truth);
  EXPECT_LT(slight, 1.0);
  EXPECT_LT(strong, slight);
}

TEST(SsimTest, OfTwoConstantImagesIsTheLuminanceTermAlone) {
  const cv::Mat a(40, 40, CV_8UC1, cv::Scalar(100));
  const cv::Mat b(40, 40, CV_8UC1, cv::Scalar(150));
  if (!isAvailable(OptionalLibrary::kOpencvQuality)) {
    EXPECT_THROW(ssim(a, b), UnavailableError);
    return;
  }
  const double c1 = std::pow(0.01 * 255.0, 2);
  const double expected = (2.0 * 100.0 * 150.0 + c1) / (100.0 * 100.0 + 150.0 * 150.0 + c1);
  EXPECT_NEAR(ssim(a, b), expected, 1e-3);
}

TEST(NoiseSigmaTest, FindsTheNoiseOnAGradientAndOnTexture) {
  cv::Mat gradient(120, 160, CV_8UC1);
  for (int y = 0; y < gradient.rows; ++y) {
    for (int x = 0; x < gradient.cols; ++x) {
      gradient.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(50 + x / 2 + y / 4);
    }
  }
  EXPECT_NEAR(noiseSigma(withNoise(gradient, 5.0)), 5.0, 0.3);
  EXPECT_NEAR(noiseSigma(withNoise(texturedImage(), 10.0)), 10.0, 1.5);
}

TEST(SharpnessTest, OfAVerticalStepIsThatByHand) {
  cv::Mat step(10, 12, CV_8UC1, cv::Scalar(40));
  step.colRange(6, 12).setTo(120);
  const Sharpness measured = sharpness(step);
  // Two columns of the ten that count see a gradient of (120 - 40) / 2.
  EXPECT_NEAR(measured.tenengrad, 40.0 * 40.0 * 2.0 / 10.0, 1e-3);
  EXPECT_EQ(measured.noise_sigma_dn, 0.0);
  EXPECT_NEAR(measured.tenengrad_above_noise, measured.tenengrad, 1e-9);
}

TEST(SharpnessTest, FallsWithBlur) {
  const cv::Mat sharp = texturedImage();
  EXPECT_LT(sharpness(blurred(sharp, 2.0)).tenengrad, 0.7 * sharpness(sharp).tenengrad);
  EXPECT_LT(sharpness(blurred(sharp, 2.0)).tenengrad_above_noise,
            0.7 * sharpness(sharp).tenengrad_above_noise);
}

TEST(SharpnessTest, NoiseRaisesTheTenengradButNotTheOneAboveNoise) {
  const cv::Mat flat(120, 160, CV_8UC1, cv::Scalar(128));
  const Sharpness noisy = sharpness(withNoise(flat, 8.0));
  EXPECT_NEAR(noisy.tenengrad, 3.0 / 8.0 * 64.0, 2.0);
  EXPECT_LT(noisy.tenengrad_above_noise, 2.5);
}

TEST(SharpnessTest, RefusesWhatIsTooSmall) {
  EXPECT_THROW(sharpness(cv::Mat(2, 20, CV_8UC1, cv::Scalar(0))), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
