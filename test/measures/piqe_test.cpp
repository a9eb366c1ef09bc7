#include "measures/piqe.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "evaluation/test_images.hpp"

namespace fast_edi {
namespace {

constexpr double kSampleFactor = 256.0 / 255.0;  // variance of a sample of 256 over its mean square

cv::Mat1d block(double (*value)(int x, int y)) {
  cv::Mat1d coefficients(kPiqeBlockPx, kPiqeBlockPx);
  for (int y = 0; y < kPiqeBlockPx; ++y) {
    for (int x = 0; x < kPiqeBlockPx; ++x) {
      coefficients(y, x) = value(x, y);
    }
  }
  return coefficients;
}

TEST(PiqeBlockTest, AConstantBlockIsNotActive) {
  const PiqeBlock result = assessPiqeBlock(block([](int, int) { return 0.7; }));
  EXPECT_NEAR(result.variance, 0.0, 1e-12);
  EXPECT_FALSE(result.active);
  EXPECT_EQ(result.distortion(), 0.0);
}

TEST(PiqeBlockTest, ACheckerboardIsNoise) {
  const PiqeBlock result =
      assessPiqeBlock(block([](int x, int y) { return (x + y) % 2 == 0 ? 0.5 : -0.5; }));
  EXPECT_NEAR(result.variance, 0.25 * kSampleFactor, 1e-12);
  EXPECT_TRUE(result.active);
  EXPECT_FALSE(result.noticeable);
  // sigma = 0.501, r = 1.014 (samples of 32 and 224), beta = 0.506: not above twice beta.
  EXPECT_FALSE(result.noise);

  const PiqeBlock strong =
      assessPiqeBlock(block([](int x, int y) { return (x + y) % 2 == 0 ? 0.9 : -0.9; }));
  // sigma = 0.902, beta = 0.111.
  EXPECT_TRUE(strong.noise);
  EXPECT_NEAR(strong.distortion(), 0.81 * kSampleFactor, 1e-12);
}

TEST(PiqeBlockTest, AFlatSegmentOnAnEdgeIsANoticeableDistortion) {
  cv::Mat1d coefficients = block([](int x, int y) { return (x + y) % 2 == 0 ? 0.4 : -0.4; });
  EXPECT_FALSE(assessPiqeBlock(coefficients).noticeable);
  coefficients(cv::Range(15, 16), cv::Range(5, 10)) = 0.0;
  EXPECT_FALSE(assessPiqeBlock(coefficients).noticeable) << "five pixels are no segment";
  coefficients(15, 10) = 0.0;
  const PiqeBlock result = assessPiqeBlock(coefficients);
  EXPECT_TRUE(result.noticeable);
  EXPECT_NEAR(result.distortion(), 1.0 - result.variance, 1e-12);
}

/// Whether a checkerboard of \p amplitude is noise when a column, counted from 1, is multiplied.
bool isNoiseWithColumn(double amplitude, int column, double factor) {
  cv::Mat1d coefficients = block([](int x, int y) { return (x + y) % 2 == 0 ? 1.0 : -1.0; });
  coefficients *= amplitude;
  coefficients.col(column - 1) *= factor;
  return assessPiqeBlock(coefficients).noise;
}

// It is noise for sigma > 2 r / (r + 2), as long as sigma < r.
TEST(PiqeBlockTest, ColumnTenIsNeitherCentreNorSurround) {
  EXPECT_TRUE(isNoiseWithColumn(0.70, 10, 0.0)) << "sigma = 0.679, r = 1.014: above 0.673";
  EXPECT_FALSE(isNoiseWithColumn(0.70, 12, 0.0)) << "sigma = 0.679, r = 1.052: below 0.689";
}

TEST(PiqeBlockTest, ColumnNineIsBothCentreAndSurround) {
  // sigma = 0.862; r = 1.455: above 0.842. Without column 9 in the surround r = 1.603: below 0.890.
  EXPECT_TRUE(isNoiseWithColumn(0.79, 9, 2.0));
}

TEST(PiqeBlockTest, ThresholdOfActivityIsAVarianceOfOneTenth) {
  const double at_threshold = std::sqrt(0.1 / kSampleFactor);
  cv::Mat1d coefficients = block([](int x, int y) { return (x + y) % 2 == 0 ? 1.0 : -1.0; });
  EXPECT_FALSE(assessPiqeBlock(coefficients * (at_threshold * 0.999)).active);
  EXPECT_TRUE(assessPiqeBlock(coefficients * (at_threshold * 1.001)).active);
}

TEST(NormalisedCoefficientsTest, OfOneBrightPixelAreThoseByHand) {
  cv::Mat image(21, 21, CV_8UC1, cv::Scalar(50));
  image.at<std::uint8_t>(10, 10) = 150;
  double sum = 0.0;
  for (int i = -3; i <= 3; ++i) {
    sum += std::exp(-i * i / (2.0 * 49.0 / 36.0));
  }
  const double centre_weight = 1.0 / (sum * sum);
  const double mean = 50.0 + 100.0 * centre_weight;
  const double deviation = 100.0 * std::sqrt(centre_weight * (1.0 - centre_weight));
  const cv::Mat1d coefficients = normalisedCoefficients(image);
  EXPECT_NEAR(coefficients(10, 10), (150.0 - mean) / (deviation + 1.0), 1e-6);
  EXPECT_NEAR(coefficients(2, 2), 0.0, 1e-6) << "out of the window's reach";
}

TEST(PiqeTest, AnImageWithoutActiveBlocksScoresOneHundred) {
  const PiqeResult result = piqe(cv::Mat(40, 50, CV_8UC1, cv::Scalar(90)));
  EXPECT_EQ(result.blocks, 3 * 4);
  EXPECT_EQ(result.active_blocks, 0);
  EXPECT_NEAR(result.score, 100.0, 1e-9);
}

TEST(PiqeTest, OfACheckerboardIsPooledAsByHand) {
  cv::Mat image(64, 64, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint8_t>(y, x) = (x + y) % 2 == 0 ? 100 : 140;
    }
  }
  const PiqeResult result = piqe(image);
  EXPECT_EQ(result.active_blocks, 16);
  EXPECT_EQ(result.noise_blocks, 16);
  EXPECT_EQ(result.noticeable_blocks, 0);
  // Coefficients are +-20 / 21; the borders differ a little.
  const double variance = std::pow(20.0 / 21.0, 2) * kSampleFactor;
  EXPECT_NEAR(result.score, 100.0 * (16.0 * variance + 1.0) / 17.0, 0.5);
}

TEST(PiqeTest, BlurNoiseAndBlockingRaiseTheScore) {
  const cv::Mat sharp = withNoise(texturedImage({352, 256}), 2.0);
  const double score = piqe(sharp).score;
  cv::Mat blocky;
  cv::resize(sharp, blocky, {}, 0.125, 0.125, cv::INTER_AREA);
  cv::resize(blocky, blocky, sharp.size(), 0.0, 0.0, cv::INTER_NEAREST);
  EXPECT_GT(piqe(blurred(sharp, 3.0)).score, score);
  EXPECT_GT(piqe(withNoise(sharp, 25.0)).score, score);
  EXPECT_GT(piqe(blocky).score, score);
}

TEST(PiqeTest, RefusesColour) {
  EXPECT_THROW(piqe(cv::Mat(32, 32, CV_8UC3)), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
