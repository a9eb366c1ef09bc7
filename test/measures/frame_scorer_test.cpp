#include "measures/frame_scorer.hpp"

#include <gmock/gmock.h>

#include "evaluation/test_images.hpp"
#include "measures/capability.hpp"
#include "measures/image_metrics.hpp"

namespace fast_edi {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(FrameScorerTest, SaysWhatItCannotMeasure) {
  ScorerOptions options;
  options.brisque_model_file = "/nonexistent/model.yml";
  const FrameScorer scorer(options);
  EXPECT_THAT(scorer.missing(), Contains(HasSubstr("BRISQUE")));
  EXPECT_THAT(scorer.missing(), Contains("SSEQ: no model folder was given"));
  FeatureMemory memory;
  const Scores scores = scorer.score(texturedImage(), TrueFrame(), memory);
  EXPECT_FALSE(scores[indexOf(Measure::kBrisque)].has_value());
  EXPECT_FALSE(scores[indexOf(Measure::kSseq)].has_value());
  EXPECT_FALSE(scores[indexOf(Measure::kPsnr)].has_value()) << "no truth was given";
  EXPECT_TRUE(scores[indexOf(Measure::kPiqe)].has_value());
}

TEST(FrameScorerTest, AModelFolderThatWasGivenMustBeReadable) {
  ScorerOptions options;
  options.sseq_folder = "/nonexistent";
  if (isAvailable(OptionalLibrary::kLibsvm)) {
    EXPECT_THROW(FrameScorer{options}, std::runtime_error);
  } else {
    EXPECT_THAT(FrameScorer(options).missing(), Contains(HasSubstr("SSEQ needs libsvm")));
  }
}

TEST(FrameScorerTest, FullReferenceOnlyMeasuresNothingElse) {
  ScorerOptions options;
  options.extent = MeasureExtent::kReference;
  const FrameScorer scorer(options);
  const cv::Mat truth = texturedImage();
  const cv::Mat image = withNoise(truth, 5.0);
  FeatureMemory memory;
  const Scores scores = scorer.score(image, scorer.trueFrame(truth), memory);
  EXPECT_EQ(scores[indexOf(Measure::kPsnr)], psnr(image, truth));
  EXPECT_EQ(scores[indexOf(Measure::kSsim)].has_value(),
            isAvailable(OptionalLibrary::kOpencvQuality));
  for (std::size_t i = indexOf(Measure::kPiqe); i < kMeasureCount; ++i) {
    EXPECT_FALSE(scores[i].has_value()) << describe(static_cast<Measure>(i)).name;
  }
}

TEST(FrameScorerTest, FeaturesAreMatchedWithTheFrameBeforeIfThereIsOne) {
  const FrameScorer scorer({});
  const cv::Mat image = texturedImage({346, 260});
  FeatureMemory memory;
  EXPECT_FALSE(scorer.score(image, TrueFrame(), memory)[indexOf(Measure::kOrb)].has_value());
  const std::optional<double> second =
      scorer.score(image, TrueFrame(), memory)[indexOf(Measure::kOrb)];
  ASSERT_TRUE(second.has_value());
  EXPECT_GT(*second, 100.0);
  memory.clear();
  EXPECT_FALSE(scorer.score(image, TrueFrame(), memory)[indexOf(Measure::kOrb)].has_value());
}

TEST(FrameScorerTest, FeaturesAreMatchedWithTheTrueNextFrameToo) {
  ScorerOptions options;
  options.extent = MeasureExtent::kFrontEnd;
  const FrameScorer scorer(options);
  const cv::Mat truth = texturedImage({346, 260});
  const cv::Mat noisy = withNoise(truth, 20.0);
  FeatureMemory memory;
  const std::size_t true_next = indexOf(Measure::kTrueNextFastBrisk);
  EXPECT_FALSE(scorer.score(noisy, scorer.trueFrame(truth), memory)[true_next].has_value());
  const Scores scores = scorer.score(noisy, scorer.trueFrame(truth), memory);
  // The same noise in both frames matches itself; it is not in the truth.
  EXPECT_LT(scores[true_next].value(), 0.5 * scores[indexOf(Measure::kFastBrisk)].value());
  EXPECT_FALSE(scorer.score(noisy, TrueFrame(), memory)[true_next].has_value());
  EXPECT_FALSE(scores[indexOf(Measure::kPiqe)].has_value()) << "was not asked for";
}

TEST(FrameScorerTest, TracksAreCountedFromTheSecondFrameOn) {
  ScorerOptions options;
  options.extent = MeasureExtent::kTracks;
  const FrameScorer scorer(options);
  const cv::Mat image = texturedImage({346, 260});
  FeatureMemory memory;
  EXPECT_FALSE(
      scorer.score(image, TrueFrame(), memory)[indexOf(Measure::kTracksClose)].has_value());
  const Scores second = scorer.score(image, TrueFrame(), memory);
  EXPECT_GT(second[indexOf(Measure::kTracksClose)].value(), 50.0);
  EXPECT_GT(second[indexOf(Measure::kTracksClose)], second[indexOf(Measure::kTracksWide)]);
  EXPECT_DOUBLE_EQ(second[indexOf(Measure::kTrackAge)].value(), 2.0);
  EXPECT_DOUBLE_EQ(second[indexOf(Measure::kMovedShare)].value(), 1.0);
  EXPECT_FALSE(second[indexOf(Measure::kOrb)].has_value()) << "was not asked for";
  memory.clear();
  EXPECT_FALSE(scorer.score(image, TrueFrame(), memory)[indexOf(Measure::kTracksWide)].has_value());
}

TEST(MeasureExtentTest, HasNames) {
  EXPECT_EQ(measureExtentFromName("front-end"), MeasureExtent::kFrontEnd);
  EXPECT_THROW(measureExtentFromName("some"), std::invalid_argument);
}

TEST(MeasureTest, EachHasANameOfItsOwn) {
  for (std::size_t i = 0; i < kMeasureCount; ++i) {
    for (std::size_t j = i + 1; j < kMeasureCount; ++j) {
      EXPECT_STRNE(describe(static_cast<Measure>(i)).name, describe(static_cast<Measure>(j)).name);
    }
  }
  EXPECT_STREQ(describe(Measure::kOrb).name, "inliers ORB");
  EXPECT_FALSE(describe(Measure::kPiqe).higher_is_better);
}

}  // namespace
}  // namespace fast_edi
