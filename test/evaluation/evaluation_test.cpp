#include "evaluation/evaluation.hpp"

#include <gtest/gtest.h>

#include "fast_edi/base/deblur_counters.hpp"

namespace fast_edi {
namespace {

ScorerOptions skipping(int frames) {
  ScorerOptions options;
  options.extent = MeasureExtent::kReference;
  options.first_frames_unscored = frames;
  return options;
}

ComparedFrame frameAt(std::int64_t stamp_ns, bool compared = true) {
  ComparedFrame frame;
  frame.stamp_ns = stamp_ns;
  frame.compared = compared;
  frame.pass_reason = PassReason::kEventsMissing;
  for (const Method method :
       {Method::kBlurry, Method::kPlain, Method::kCounter, Method::kSearched, Method::kOurs}) {
    frame.images[indexOf(method)] = cv::Mat(40, 60, CV_8UC1, cv::Scalar(100));
  }
  return frame;
}

cv::Mat truthAt(std::int64_t stamp_ns) {
  return cv::Mat(40, 60, CV_8UC1, cv::Scalar(100.0 + static_cast<double>(stamp_ns)));
}

TEST(EvaluationRecorder, FramesAtTheStartMayBeLeftUnscored) {
  const FrameScorer scorer(skipping(2));
  EvaluationRecorder recorder("name", scorer, truthAt);
  for (const std::int64_t stamp_ns : {1, 2, 3, 4}) {
    recorder.add(frameAt(stamp_ns));
  }
  const Evaluation& evaluation = recorder.evaluation();
  ASSERT_EQ(evaluation.frames.size(), 2U);
  EXPECT_EQ(evaluation.frames[0].stamp_ns, 3);
  EXPECT_EQ(evaluation.frames[1].stamp_ns, 4);
  EXPECT_TRUE(evaluation.left_out.empty());
}

TEST(EvaluationRecorder, ScoresTheFramesThatWereChosen) {
  ScorerOptions options = skipping(1);
  options.scored = FrameChoice("1-2,4");
  const FrameScorer scorer(options);
  EvaluationRecorder recorder("name", scorer, truthAt);
  for (const std::int64_t stamp_ns : {1, 2, 3, 4, 5}) {
    recorder.add(frameAt(stamp_ns, stamp_ns != 5));
  }
  const Evaluation& evaluation = recorder.evaluation();
  ASSERT_EQ(evaluation.frames.size(), 2U);
  EXPECT_EQ(evaluation.frames[0].stamp_ns, 2) << "the first frame is skipped all the same";
  EXPECT_EQ(evaluation.frames[1].stamp_ns, 4);
  EXPECT_TRUE(evaluation.left_out.empty()) << "nobody asked for the fifth";
}

TEST(EvaluationRecorder, FramesThatCouldNotBeComparedAreCounted) {
  const FrameScorer scorer(skipping(0));
  EvaluationRecorder recorder("name", scorer, truthAt);
  recorder.add(frameAt(1, false));
  recorder.add(frameAt(2));
  EXPECT_EQ(recorder.evaluation().frames.size(), 1U);
  EXPECT_EQ(recorder.evaluation().left_out.at(toString(PassReason::kEventsMissing)), 1U);
}

/// Darker than the frame, and none for the frame at 2 ns.
class Darkening : public OtherMethod {
 public:
  std::string name() const override { return "darkening"; }
  Result deblur(const Frame& frame) override {
    return frame.stamp_ns == 2 ? Result() : Result{frame.blurry - cv::Scalar(50), 4.0};
  }
};

TEST(EvaluationRecorder, OtherMethodsAreColumnsOfTheirOwn) {
  const FrameScorer scorer(skipping(0));
  OtherMethods others;
  others.push_back(std::make_unique<Darkening>());
  EvaluationRecorder recorder("name", scorer, truthAt, others);
  for (const std::int64_t stamp_ns : {1, 2, 3}) {
    recorder.add(frameAt(stamp_ns));
  }
  const Evaluation& evaluation = recorder.evaluation();
  ASSERT_EQ(evaluation.others, std::vector<std::string>{"darkening"});
  const auto& frames = evaluation.frames;
  EXPECT_FALSE(frames[1].scores[kMethodCount][indexOf(Measure::kPsnr)].has_value());
  EXPECT_LT(*evaluation.mean(kMethodCount, Measure::kPsnr),
            *evaluation.mean(Method::kBlurry, Measure::kPsnr));
  EXPECT_EQ(evaluation.example[kMethodCount].at<std::uint8_t>(0, 0), 50);
  EXPECT_EQ(evaluation.medianRuntimeMs(kMethodCount), 4.0) << "of the frames that it has";
}

TEST(Evaluation, MeansAreThoseOfTheFramesThatHaveTheMeasure) {
  Evaluation evaluation;
  evaluation.frames.resize(3);
  evaluation.frames[0].scores[indexOf(Method::kOurs)][indexOf(Measure::kPsnr)] = 30.0;
  evaluation.frames[2].scores[indexOf(Method::kOurs)][indexOf(Measure::kPsnr)] = 34.0;
  EXPECT_EQ(evaluation.mean(Method::kOurs, Measure::kPsnr), 32.0);
  EXPECT_FALSE(evaluation.mean(Method::kPlain, Measure::kPsnr).has_value());
}

}  // namespace
}  // namespace fast_edi
