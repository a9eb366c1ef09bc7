#include "evaluation/contrast_search.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "evaluation/test_images.hpp"

namespace fast_edi {
namespace {

constexpr double kLambda = 0.2;

/// An event map as of a camera that saw every edge of the image move.
cv::Mat1f edgesOf(const cv::Mat& image) {
  cv::Mat1f gx;
  cv::Mat1f gy;
  cv::Sobel(image, gx, CV_32F, 1, 0);
  cv::Sobel(image, gy, CV_32F, 0, 1);
  cv::Mat1f edges;
  cv::magnitude(gx, gy, edges);
  return edges;
}

TEST(FibonacciSearchTest, FindsAMinimumToItsResolution) {
  for (const double truth : {0.06, 0.2609, 0.5, 0.69}) {
    const Minimum minimum =
        fibonacciSearch([truth](double x) { return (x - truth) * (x - truth); }, 0.05, 0.7, 200);
    EXPECT_NEAR(minimum.position, truth, 0.65 / 200.0);
    EXPECT_LE(minimum.evaluations, 14);
  }
}

TEST(FibonacciSearchTest, EvaluatesNoPositionTwice) {
  std::vector<double> positions;
  fibonacciSearch(
      [&](double x) {
        positions.push_back(x);
        return std::abs(x - 1.7);
      },
      0.0, 13.0, 13);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t j = i + 1; j < positions.size(); ++j) {
      EXPECT_NE(positions[i], positions[j]);
    }
  }
}

TEST(FibonacciSearchTest, RefusesAnEmptyRange) {
  const auto square = [](double x) { return x * x; };
  EXPECT_THROW(fibonacciSearch(square, 1.0, 1.0, 10), std::invalid_argument);
  EXPECT_THROW(fibonacciSearch(square, 0.0, 1.0, 1), std::invalid_argument);
}

TEST(EventEdgeMapTest, WeightsEventsByDistanceFromTheReference) {
  const std::vector<Event> events = {{1, 0, 1000, true}, {1, 0, 1500, false}, {2, 1, 400, false}};
  const cv::Mat1f map = eventEdgeMap(events, {3, 2}, 1000, 500);
  EXPECT_NEAR(map(0, 1), 1.0 - std::exp(-1.0), 1e-6);
  EXPECT_NEAR(map(1, 2), std::exp(-1.2), 1e-6);
  EXPECT_EQ(map(0, 0), 0.0F);
  EXPECT_THROW(eventEdgeMap(events, {3, 2}, 1000, 0), std::invalid_argument);
}

TEST(TotalVariationTest, OfAStepIsThatByHand) {
  cv::Mat step(20, 40, CV_8UC1, cv::Scalar(50));
  step.colRange(20, 40).setTo(101);
  EXPECT_NEAR(totalVariation(step), 20 * 51.0, 1e-3);
}

TEST(SharpnessEnergyTest, FallsWithEdgesWhereEventsAreAndRisesWithVariation) {
  const cv::Mat sharp = texturedImage();
  const cv::Mat blurry = blurred(sharp, 3.0);
  const SharpnessEnergy energy(blurry, edgesOf(sharp), kLambda);
  EXPECT_LT(energy(sharp), energy(blurry));
  EXPECT_GT(energy(withNoise(sharp, 30.0)), energy(sharp));
}

TEST(SharpnessEnergyTest, OfTheBlurryFrameWithoutEventsIsLambda) {
  const cv::Mat blurry = texturedImage();
  EXPECT_NEAR(SharpnessEnergy(blurry, cv::Mat1f(blurry.size(), 0.0F), kLambda)(blurry), kLambda,
              1e-9);
  const cv::Mat flat(20, 20, CV_8UC1, cv::Scalar(9));
  EXPECT_EQ(SharpnessEnergy(flat, cv::Mat1f(flat.size(), 0.0F), kLambda)(flat), 0.0);
  EXPECT_THROW(SharpnessEnergy(flat, cv::Mat1f(3, 3, 0.0F), kLambda), std::invalid_argument);
}

TEST(SearchContrastTest, FindsWhatIsSharpest) {
  // An image that blurs as the contrast leaves its true value to either side.
  constexpr double kTruth = 0.3;
  constexpr double kSigmaPerContrast = 40.0;
  const cv::Mat sharp = texturedImage();
  const ContrastSearchResult result = searchContrast(
      [&](double contrast) -> cv::Mat {
        return blurred(sharp, 0.01 + kSigmaPerContrast * std::abs(contrast - kTruth));
      },
      SharpnessEnergy(blurred(sharp, 3.0), edgesOf(sharp), kLambda));
  EXPECT_NEAR(result.contrast, kTruth, 0.03);
  EXPECT_GT(result.evaluations, 5);
}

}  // namespace
}  // namespace fast_edi
