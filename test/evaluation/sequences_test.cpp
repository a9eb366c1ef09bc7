#include "fast_edi/evaluation/sequences.hpp"

#include <set>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

ScorerOptions fullReferenceOnly() {
  ScorerOptions options;
  options.full_reference_only = true;
  return options;
}

DeblurParameters someParameters() {
  DeblurParameters parameters;
  parameters.thresholds = {1.0, 1.0};  // to be replaced by the simulated sensor's
  return parameters;
}

TEST(EvaluationSequencesTest, AreSixScenesByTwoSeedsHalfOfThemForTuning) {
  const std::vector<EvaluationSequence> sequences = evaluationSequences();
  EXPECT_EQ(sequences.size(), 12U);
  std::set<std::string> names;
  std::set<TextureKind> tuned_textures;
  int for_tuning = 0;
  for (const EvaluationSequence& sequence : sequences) {
    names.insert(sequence.name);
    EXPECT_NO_THROW(sequence.settings.validate()) << sequence.name;
    EXPECT_GT(sequence.settings.sensor.threshold_mismatch, 0.0);
    if (sequence.for_tuning) {
      ++for_tuning;
      tuned_textures.insert(sequence.settings.scene.texture);
    }
  }
  EXPECT_EQ(names.size(), sequences.size());
  EXPECT_EQ(for_tuning, 6);
  for (const EvaluationSequence& sequence : sequences) {
    EXPECT_EQ(tuned_textures.count(sequence.settings.scene.texture) == 1, sequence.for_tuning)
        << sequence.name << ": a texture used for tuning must not test the result";
  }
}

TEST(EvaluationSequencesTest, RefusesEmptySets) {
  EXPECT_THROW(evaluationSequences(0, 1), std::invalid_argument);
  EXPECT_THROW(evaluationSequences(1, 0), std::invalid_argument);
}

class StrongBlurTest : public testing::Test {
 protected:
  static constexpr int kFrames = 2;

  static EvaluationSequence sequence() { return evaluationSequences(kFrames, 1).front(); }
  static Evaluation evaluate(double threshold_factor, int& reported) {
    const FrameScorer scorer(fullReferenceOnly());
    return evaluateSequence(sequence(), someParameters(), threshold_factor, {}, scorer,
                            [&reported](int done) { reported = done; });
  }
  static double psnr(const Evaluation& evaluation, Method method) {
    return evaluation.mean(method, Measure::kPsnr).value();
  }
};

TEST_F(StrongBlurTest, EdiGainsAndWrongThresholdsCost) {
  int reported = 0;
  const Evaluation evaluation = evaluate(1.0, reported);
  EXPECT_EQ(reported, kFrames);
  ASSERT_EQ(evaluation.frames.size(), static_cast<std::size_t>(kFrames));
  EXPECT_TRUE(evaluation.left_out.empty());
  const double blurry = psnr(evaluation, Method::kBlurry);
  EXPECT_GT(psnr(evaluation, Method::kPlain), blurry + 2.0);
  EXPECT_GT(psnr(evaluation, Method::kPlain), psnr(evaluation, Method::kCounter));
  EXPECT_GT(psnr(evaluation, Method::kSearched), blurry + 1.0);
  EXPECT_GE(psnr(evaluation, Method::kOurs), blurry);
  EXPECT_FALSE(evaluation.mean(Method::kTruth, Measure::kPsnr).has_value());
  EXPECT_FALSE(evaluation.example[indexOf(Method::kTruth)].empty());
  for (const FrameFigures& frame : evaluation.frames) {
    EXPECT_GT(frame.events, 10'000U);
    EXPECT_GT(frame.searched_contrast, 0.1);
    EXPECT_LT(frame.searched_contrast, 0.4);
    EXPECT_EQ(frame.exposure_ns, sequence().settings.timing.exposure_us * 1000);
    EXPECT_GT(frame.runtime_ms[indexOf(Method::kSearched)],
              frame.runtime_ms[indexOf(Method::kPlain)]);
  }
  const Evaluation wrong = evaluate(1.5, reported);
  EXPECT_LT(psnr(wrong, Method::kPlain), psnr(evaluation, Method::kPlain));
  EXPECT_EQ(psnr(wrong, Method::kSearched), psnr(evaluation, Method::kSearched))
      << "the search must not depend on the thresholds given";
}

TEST_F(StrongBlurTest, TheSameSeedGivesTheSameFigures) {
  int reported = 0;
  const Evaluation first = evaluate(1.0, reported);
  const Evaluation second = evaluate(1.0, reported);
  ASSERT_EQ(first.frames.size(), second.frames.size());
  for (std::size_t i = 0; i < first.frames.size(); ++i) {
    EXPECT_EQ(first.frames[i].scores, second.frames[i].scores);
    EXPECT_EQ(first.frames[i].searched_contrast, second.frames[i].searched_contrast);
  }
}

}  // namespace
}  // namespace fast_edi
