#include "sequences/set_evaluation.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>

#include "sequences/set_report.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using testing::HasSubstr;

/// A short sequence on a small sensor.
SetSequence smallSequence(double threshold_factor = 1.0) {
  SetSequence entry;
  entry.sequence.name = "small";
  entry.factors = {"clean", "> 10 px", "bright", "full", "right"};
  entry.threshold_factor = threshold_factor;
  SimulationSettings& settings = entry.sequence.settings;
  settings.sensor.size = {120, 90};
  settings.timing.frames = 3;
  return entry;
}

std::vector<Variant> twoVariants() {
  Variant ours{"ours", {}};
  Variant unfiltered{"unfiltered", {}};
  for (Variant* variant : {&ours, &unfiltered}) variant->parameters.thresholds = {1.0, 1.0};
  unfiltered.parameters.filter.enabled = false;
  return {ours, unfiltered};
}

SetResult evaluate(const SetSequence& sequence, MeasureExtent extent, int skip = 0) {
  ScorerOptions options;
  options.extent = extent;
  options.first_frames_unscored = skip;
  const FrameScorer scorer(options);
  int reported = 0;
  SetResult result =
      evaluateVariants(sequence, twoVariants(), scorer, [&](int done) { reported = done; });
  EXPECT_EQ(reported, sequence.sequence.settings.timing.frames);
  return result;
}

TEST(SetEvaluationTest, VariantsSeeTheSameInput) {
  const SetResult result = evaluate(smallSequence(), MeasureExtent::kTracks);
  EXPECT_EQ(columnNames(twoVariants()),
            (std::vector<std::string>{"blurry", "plain EDI", "ours", "unfiltered", "true frames"}));
  ASSERT_EQ(result.scores.size(), 5U);
  for (const auto& column : result.scores) EXPECT_EQ(column.size(), 3U);
  EXPECT_EQ(result.left_out, 0);
  // Without filters a variant is plain EDI, number by number.
  EXPECT_EQ(result.scores[3], result.scores[kPlainColumn]);
  EXPECT_GT(result.mean(2, Measure::kPsnr).value(),
            result.mean(kPlainColumn, Measure::kPsnr).value());
  EXPECT_GT(result.mean(kPlainColumn, Measure::kPsnr).value(),
            result.mean(kBlurryColumn, Measure::kPsnr).value());
  EXPECT_FALSE(result.mean(4, Measure::kPsnr).has_value()) << "the truth against itself";
  EXPECT_TRUE(result.mean(4, Measure::kTracksClose).has_value());
}

TEST(SetEvaluationTest, GivesWrongThresholdsWhereTheSequenceSaysSo) {
  const SetResult right = evaluate(smallSequence(), MeasureExtent::kReference);
  const SetResult wrong = evaluate(smallSequence(1.5), MeasureExtent::kReference);
  EXPECT_EQ(wrong.scores[kBlurryColumn], right.scores[kBlurryColumn]);
  EXPECT_LT(wrong.mean(kPlainColumn, Measure::kPsnr), right.mean(kPlainColumn, Measure::kPsnr));
}

TEST(SetEvaluationTest, FirstFramesMayBeLeftUnscored) {
  const SetResult all = evaluate(smallSequence(), MeasureExtent::kReference);
  const SetResult later = evaluate(smallSequence(), MeasureExtent::kReference, 1);
  ASSERT_EQ(later.scores[2].size(), 2U);
  EXPECT_EQ(later.scores[2][0], all.scores[2][1]);
}

/// Two sequences with made-up figures.
SetEvaluation madeUp() {
  SetEvaluation evaluation;
  evaluation.columns = {"blurry", "plain EDI", "ours", "true frames"};
  const auto add = [&](const std::string& name, const std::string& light,
                       std::array<double, 3> psnr) {
    SetResult result;
    result.name = name;
    result.factors = {"clean", "< 3 px", light, "full", "right"};
    result.scores.assign(4, std::vector<Scores>(1));
    result.runtime_ms.assign(4, {1.5});
    for (std::size_t i = 0; i < psnr.size(); ++i) {
      result.scores[i][0][indexOf(Measure::kPsnr)] = psnr[i];
    }
    evaluation.results.push_back(result);
  };
  add("first", "bright", {20.0, 30.0, 34.0});
  add("second", "dim", {31.0, 30.0, 29.0});
  return evaluation;
}

TEST(SetReportTest, GainsByFactorAreMeanAndWorst) {
  std::ostringstream out;
  printSetFactors(out, madeUp());
  EXPECT_THAT(out.str(),
              HasSubstr("| light: bright | 1 | 34.00 | +4.00 (+4.00) | +14.00 (+14.00)"));
  EXPECT_THAT(out.str(), HasSubstr("| light: dim | 1 | 29.00 | -1.00 (-1.00) | -2.00 (-2.00)"));
  EXPECT_THAT(out.str(),
              HasSubstr("| all | 2 | 31.50 | +1.50 (-1.00) | +6.00 (-2.00) | - | - | - |"));
}

TEST(SetReportTest, MembersComeWithTheirFactorsAndTheMean) {
  std::ostringstream out;
  printSetMembers(out, madeUp(), Measure::kPsnr);
  EXPECT_THAT(out.str(), HasSubstr("| second | clean | < 3 px | dim | full | right | 31.00 | "
                                   "30.00 | 29.00 | - |"));
  EXPECT_THAT(out.str(), HasSubstr("| mean | | | | | | 25.50 | 30.00 | 31.50 | - |"));
  std::ostringstream measures;
  printSetMeasures(measures, madeUp());
  EXPECT_THAT(measures.str(), HasSubstr("| PSNR [dB] | 25.50 | 30.00 | 31.50 | - |"));
}

TEST(SetReportTest, SharesOfWhatAFrontEndKeeps) {
  SetEvaluation evaluation = madeUp();
  const auto setTracks = [&](std::size_t sequence, const std::vector<double>& tracks) {
    for (std::size_t column = 0; column < tracks.size(); ++column) {
      evaluation.results[sequence].scores[column][0][indexOf(Measure::kTracksClose)] =
          tracks[column];
    }
  };
  setTracks(0, {100.0, 50.0, 90.0, 120.0});
  setTracks(1, {2.0, 40.0, 32.0, 5.0});
  std::ostringstream out;
  printSetShares(out, evaluation);
  // The true frames of the second have too few tracks to compare with.
  EXPECT_THAT(out.str(),
              HasSubstr("| tracks 10 px apart | 85 % (80 %) | 130 % (80 %) | 75 % (75 %) |"));
  // Of what has noise, a front end may keep more than of the truth.
  EXPECT_THAT(out.str(), HasSubstr("| true frames | of the better of plain EDI and blurry"));
  EXPECT_THAT(out.str(), HasSubstr("| tracks 10 px apart | 66 % (12 %) | 126 % (12 %) | 100 % "));
  EXPECT_THAT(out.str(), testing::Not(HasSubstr("inliers")));
}

TEST(SetReportTest, WritesEveryScore) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("set.csv");
  writeSetScores(path, madeUp());
  std::ifstream file(path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_THAT(text, HasSubstr("sequence,sensor,blur,light,contrast,thresholds,frame,method,"));
  EXPECT_THAT(text, HasSubstr("second,clean,< 3 px,dim,full,right,0,ours,1.5,29,,"));
  EXPECT_THROW(writeSetScores("/nonexistent/set.csv", madeUp()), std::runtime_error);
}

}  // namespace
}  // namespace fast_edi
