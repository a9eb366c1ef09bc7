#include "measures/sseq.hpp"

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "evaluation/message_of.hpp"
#include "evaluation/test_images.hpp"
#include "measures/capability.hpp"

namespace fast_edi {
namespace {

TEST(SpatialEntropyTest, IsThatByHand) {
  cv::Mat1b block(8, 8, std::uint8_t{77});
  EXPECT_EQ(spatialEntropy(block), 0.0);
  block.colRange(0, 4) = 10;
  EXPECT_NEAR(spatialEntropy(block), 1.0, 1e-12);
  block.colRange(0, 2) = 200;
  EXPECT_NEAR(spatialEntropy(block), 1.5, 1e-12);
}

TEST(SpectralEntropyTest, IsThatByHand) {
  EXPECT_EQ(spectralEntropy(cv::Mat1b(8, 8, std::uint8_t{200})), 0.0);
  // One basis function of the transform: all power in one coefficient but for rounding to DN.
  cv::Mat1b wave(8, 8);
  cv::Mat1b two_waves(8, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const double along_x = std::cos((2 * x + 1) * 2 * CV_PI / 16.0);
      const double along_y = std::cos((2 * y + 1) * 3 * CV_PI / 16.0);
      wave(y, x) = cv::saturate_cast<std::uint8_t>(128.0 + 100.0 * along_x);
      two_waves(y, x) = cv::saturate_cast<std::uint8_t>(128.0 + 60.0 * along_x + 60.0 * along_y);
    }
  }
  EXPECT_NEAR(spectralEntropy(wave), 0.0, 0.01);
  EXPECT_NEAR(spectralEntropy(two_waves), 1.0, 0.02);
}

TEST(SkewnessTest, IsThatByHand) {
  EXPECT_EQ(skewness({3.0, 3.0, 3.0}), 0.0);
  EXPECT_NEAR(skewness({-1.0, 0.0, 1.0}), 0.0, 1e-12);
  // Mean 1, second moment 3, third moment 6.
  EXPECT_NEAR(skewness({0.0, 0.0, 0.0, 4.0}), 6.0 / std::pow(3.0, 1.5), 1e-12);
}

TEST(HalvedTest, KeepsConstantsAndRamps) {
  const cv::Mat1b constant(15, 20, std::uint8_t{90});
  const cv::Mat1b half = halved(constant);
  EXPECT_EQ(half.size(), cv::Size(10, 8));
  EXPECT_EQ(cv::norm(half, cv::Mat1b(half.size(), std::uint8_t{90}), cv::NORM_INF), 0.0);

  cv::Mat1b ramp(16, 40);
  for (int x = 0; x < ramp.cols; ++x) {
    ramp.col(x) = static_cast<std::uint8_t>(4 * x);
  }
  // Away from the borders: output 10 lies in the middle of inputs 20 and 21.
  EXPECT_EQ(halved(ramp)(4, 10), 82);
}

TEST(SseqFeaturesTest, OfAConstantImageAreZero) {
  for (const double feature : sseqFeatures(cv::Mat(64, 96, CV_8UC1, cv::Scalar(120)))) {
    EXPECT_EQ(feature, 0.0);
  }
  EXPECT_THROW(sseqFeatures(cv::Mat(7, 30, CV_8UC1, cv::Scalar(0))), std::invalid_argument);
}

TEST(SseqFeaturesTest, BlurLowersEntropiesAndNoiseRaisesThem) {
  const cv::Mat sharp = withNoise(texturedImage({352, 256}), 3.0);
  const auto features = sseqFeatures(sharp);
  const auto noisy = sseqFeatures(withNoise(sharp, 25.0));
  const auto smooth = sseqFeatures(blurred(sharp, 3.0));
  EXPECT_GT(noisy[0], features[0]);
  EXPECT_LT(smooth[0], features[0]);
  EXPECT_LT(smooth[2], features[2]);
}

TEST(SseqTest, NamesWhatIsMissing) {
  if (!isAvailable(OptionalLibrary::kLibsvm)) {
    EXPECT_THROW(Sseq("/nonexistent"), UnavailableError);
    return;
  }
  EXPECT_THAT(messageOf<std::runtime_error>([] { Sseq("/nonexistent"); }),
              testing::HasSubstr("/nonexistent/feature_range"));
}

TEST(SseqTest, WithAModelBlurAndNoiseRaiseTheScore) {
  const char* recordings = std::getenv("FAST_EDI_RECORDINGS");
  if (recordings == nullptr) {
    std::cout << "FAST_EDI_RECORDINGS is not set: SSEQ scored without a trained model only\n";
    EXPECT_THROW(Sseq(""), std::runtime_error);
    return;
  }
  const Sseq sseq(std::string(recordings) + "/sseq");
  const cv::Mat sharp = withNoise(texturedImage({352, 256}), 2.0);
  const double score = sseq.score(sharp);
  EXPECT_GT(sseq.score(blurred(sharp, 4.0)), score);
  EXPECT_GT(sseq.score(withNoise(sharp, 40.0)), score);
  EXPECT_EQ(sseq.score(sharp), score);
}

}  // namespace
}  // namespace fast_edi
