#include "fast_edi/evaluation/contrast_search.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>

#include "evaluation/test_images.hpp"

namespace fast_edi {
namespace {

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
  EXPECT_NEAR(map(1, 2), -std::exp(-1.2), 1e-6);
  EXPECT_EQ(map(0, 0), 0.0F);
  EXPECT_THROW(eventEdgeMap(events, {3, 2}, 1000, 0), std::invalid_argument);
}

TEST(BinaryEdgesTest, MarksAStepAndNothingElse) {
  cv::Mat step(20, 40, CV_8UC1, cv::Scalar(50));
  step.colRange(20, 40).setTo(90);
  const cv::Mat1b edges = binaryEdges(step);
  EXPECT_EQ(cv::countNonZero(edges), 2 * 20);
  EXPECT_EQ(edges(10, 19), 1);
  EXPECT_EQ(edges(10, 20), 1);
}

TEST(SharpnessEnergyTest, OfAStepIsThatByHand) {
  cv::Mat step(20, 40, CV_8UC1, cv::Scalar(50));
  step.colRange(20, 40).setTo(101);
  const cv::Mat1b edges = binaryEdges(step);
  // 20 rows rise by 0.2 of white; 40 edge pixels agree.
  EXPECT_NEAR(sharpnessEnergy(step, edges, 0.5), 0.5 * 20 * 0.2 - 40.0, 1e-4);
  EXPECT_THROW(sharpnessEnergy(step, cv::Mat1b(3, 3), 0.5), std::invalid_argument);
}

TEST(SearchContrastTest, FindsWhatRestoresTheImage) {
  // A blurry frame whose log difference from the truth is known: "deblurring" by c adds c / truth
  // of that difference, so that c = truth restores the image and a larger one overshoots.
  constexpr double kTruth = 0.3;
  cv::Mat1f sharp;
  texturedImage().convertTo(sharp, CV_32F);
  cv::Mat1f smooth;
  cv::GaussianBlur(sharp, smooth, {}, 3.0);
  cv::Mat1f ratio;
  cv::log(sharp / smooth, ratio);
  const cv::Mat1b edges = binaryEdges(sharp);
  const ContrastSearchResult result = searchContrast(
      [&](double contrast) -> cv::Mat {
        cv::Mat1f gain;
        cv::exp(ratio * (contrast / kTruth), gain);
        return smooth.mul(gain);
      },
      edges);
  EXPECT_NEAR(result.contrast, kTruth, 0.1);
  EXPECT_GT(result.evaluations, 5);
}

}  // namespace
}  // namespace fast_edi
