#include "measures/feature_matches.hpp"

#include <gmock/gmock.h>

#include "evaluation/test_images.hpp"
#include "measures/capability.hpp"

namespace fast_edi {
namespace {

bool canRun(FeatureMethod method) {
  return !needsDlib(method) || isAvailable(OptionalLibrary::kDlib);
}

class FeatureMethodTest : public testing::TestWithParam<FeatureMethod> {
 protected:
  // Two views of one plane, one pixel and a half apart along each axis.
  static cv::Mat firstView() { return withNoise(scene()(cv::Rect(20, 20, 346, 260)), 1.0); }
  static cv::Mat secondView() {
    cv::Mat moved;
    const cv::Mat motion = (cv::Mat_<double>(2, 3) << 1, 0, -21.5, 0, 1, -21.5);
    cv::warpAffine(scene(), moved, motion, {346, 260});
    return withNoise(moved, 1.0, kTestSeed + 1);
  }
  static cv::Mat scene() { return blurred(texturedImage({400, 310}), 0.8); }
};

TEST_P(FeatureMethodTest, MatchesTwoViewsAndRepeatsItself) {
  if (!canRun(GetParam())) {
    EXPECT_THROW(findFeatures(firstView(), GetParam()), UnavailableError);
    return;
  }
  const ImageFeatures first = findFeatures(firstView(), GetParam());
  const ImageFeatures second = findFeatures(secondView(), GetParam());
  ASSERT_EQ(first.points.size(), static_cast<std::size_t>(first.descriptors.rows));
  const MatchCounts counts = matchFeatures(first, second);
  EXPECT_EQ(counts.features_first, static_cast<int>(first.points.size()));
  EXPECT_GE(counts.inliers, kMinMatchesForModel);
  EXPECT_GE(counts.inliers, counts.matches / 2);
  EXPECT_LE(counts.inliers, counts.matches);
  const MatchCounts again =
      matchFeatures(findFeatures(firstView(), GetParam()), findFeatures(secondView(), GetParam()));
  EXPECT_EQ(again.inliers, counts.inliers);
}

TEST_P(FeatureMethodTest, TakesPartOfALargerImage) {
  if (!canRun(GetParam())) {
    EXPECT_THROW(findFeatures(firstView(), GetParam()), UnavailableError);
    return;
  }
  const cv::Mat whole = firstView();
  const cv::Mat part = whole(cv::Rect(10, 20, 200, 180));
  const ImageFeatures of_part = findFeatures(part, GetParam());
  const ImageFeatures of_copy = findFeatures(part.clone(), GetParam());
  ASSERT_FALSE(of_copy.points.empty());
  EXPECT_EQ(of_part.points, of_copy.points);
  EXPECT_EQ(cv::norm(of_part.descriptors, of_copy.descriptors, cv::NORM_INF), 0.0);
}

TEST_P(FeatureMethodTest, BlurCostsInliers) {
  if (!canRun(GetParam())) {
    EXPECT_THROW(findFeatures(firstView(), GetParam()), UnavailableError);
    return;
  }
  const auto inliers = [](const cv::Mat& a, const cv::Mat& b) {
    return matchFeatures(findFeatures(a, GetParam()), findFeatures(b, GetParam())).inliers;
  };
  EXPECT_LT(inliers(blurred(firstView(), 4.0), blurred(secondView(), 4.0)),
            inliers(firstView(), secondView()));
}

TEST_P(FeatureMethodTest, AFlatImageHasNoFeatures) {
  const cv::Mat flat(260, 346, CV_8UC1, cv::Scalar(100));
  if (!canRun(GetParam())) {
    EXPECT_THROW(findFeatures(flat, GetParam()), UnavailableError);
    return;
  }
  const ImageFeatures none = findFeatures(flat, GetParam());
  EXPECT_TRUE(none.points.empty());
  EXPECT_EQ(matchFeatures(none, none).inliers, 0);
}

TEST_P(FeatureMethodTest, HasAName) {
  EXPECT_STRNE(toString(GetParam()), "unknown");
}

INSTANTIATE_TEST_SUITE_P(All, FeatureMethodTest, testing::ValuesIn(kAllFeatureMethods));

TEST(MatchFeaturesTest, TooFewMatchesGiveNoInliers) {
  ImageFeatures few;
  for (int i = 0; i < 5; ++i) {
    few.points.emplace_back(10.0F * static_cast<float>(i), 7.0F);
    cv::Mat1f descriptor(1, 64, 0.0F);
    descriptor(0, i) = 1.0F;
    few.descriptors.push_back(descriptor);
  }
  const MatchCounts counts = matchFeatures(few, few);
  EXPECT_EQ(counts.matches, 5);
  EXPECT_EQ(counts.inliers, 0);
}

TEST(MatchFeaturesTest, MatchesOfTooFewPlacesGiveNoModelAndNoInliers) {
  // Three places with a match or two each, and all the others about a fourth.
  ImageFeatures first;
  ImageFeatures second;
  const auto addMatch = [&](cv::Point2f from, cv::Point2f to) {
    cv::Mat1f descriptor(1, 64, 0.0F);
    descriptor(0, static_cast<int>(first.points.size())) = 1.0F;
    first.points.push_back(from);
    second.points.push_back(to);
    first.descriptors.push_back(descriptor);
    second.descriptors.push_back(descriptor);
  };
  for (int i = 0; i < 17; ++i) {
    addMatch({246.8F + 0.1F * static_cast<float>(i % 2), 75.8F + 0.1F * static_cast<float>(i % 4)},
             {241.4F, 70.3F});
  }
  addMatch({125.6F, 79.5F}, {119.8F, 70.3F});
  addMatch({246.6F, 75.8F}, {241.2F, 69.8F});
  addMatch({32.5F, 196.0F}, {26.5F, 185.7F});
  addMatch({32.5F, 196.2F}, {26.5F, 185.7F});
  for (int repetition = 0; repetition < 4; ++repetition) {
    { const cv::Mat leaves_ones_on_the_heap(1, 21, CV_8UC1, cv::Scalar(1)); }
    const MatchCounts counts = matchFeatures(first, second);
    EXPECT_EQ(counts.matches, 21);
    EXPECT_EQ(counts.inliers, 0);
  }
}

}  // namespace
}  // namespace fast_edi
