#include "sequences/sequences.hpp"

#include <set>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

ScorerOptions fullReferenceOnly() {
  ScorerOptions options;
  options.extent = MeasureExtent::kReference;
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

  static void SetUpTestSuite() { right_ = new Evaluation(evaluate(1.0, reported_)); }
  static void TearDownTestSuite() {
    delete right_;
    right_ = nullptr;
  }

  static EvaluationSequence sequence() { return evaluationSequences(kFrames, 1).front(); }
  static Evaluation evaluate(double threshold_factor, int& reported) {
    const FrameScorer scorer(fullReferenceOnly());
    return evaluateSequence(sequence(), someParameters(), threshold_factor, {}, scorer, {},
                            [&reported](int done) { reported = done; });
  }
  static double psnr(const Evaluation& evaluation, Method method) {
    return evaluation.mean(method, Measure::kPsnr).value();
  }

  static Evaluation* right_;  // made once: a simulation takes seconds
  static int reported_;
};

Evaluation* StrongBlurTest::right_ = nullptr;
int StrongBlurTest::reported_ = 0;

TEST_F(StrongBlurTest, EdiGains) {
  const Evaluation& evaluation = *right_;
  EXPECT_EQ(reported_, kFrames);
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
}

TEST_F(StrongBlurTest, WrongThresholdsCostWhereTheyAreUsedAndAllElseRepeats) {
  int reported = 0;
  const Evaluation wrong = evaluate(1.5, reported);
  EXPECT_LT(psnr(wrong, Method::kPlain), psnr(*right_, Method::kPlain));
  EXPECT_LT(psnr(wrong, Method::kCounter), psnr(*right_, Method::kCounter));
  ASSERT_EQ(wrong.frames.size(), right_->frames.size());
  for (std::size_t i = 0; i < wrong.frames.size(); ++i) {
    for (const Method method : {Method::kBlurry, Method::kSearched}) {
      EXPECT_EQ(wrong.frames[i].scores[indexOf(method)], right_->frames[i].scores[indexOf(method)]);
    }
    EXPECT_EQ(wrong.frames[i].searched_contrast, right_->frames[i].searched_contrast);
    EXPECT_EQ(wrong.frames[i].events, right_->frames[i].events);
  }
}

}  // namespace
}  // namespace fast_edi
