#include "evaluation/report.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "evaluation/message_of.hpp"
#include "evaluation/plot.hpp"
#include "evaluation/test_images.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

FrameFigures frameWith(double blurry_psnr, double plain_psnr) {
  FrameFigures frame;
  frame.scores[indexOf(Method::kBlurry)][indexOf(Measure::kPsnr)] = blurry_psnr;
  frame.scores[indexOf(Method::kPlain)][indexOf(Measure::kPsnr)] = plain_psnr;
  frame.scores[indexOf(Method::kBlurry)][indexOf(Measure::kOrb)] = 40.0;
  frame.scores[indexOf(Method::kPlain)][indexOf(Measure::kOrb)] = 50.0;
  frame.runtime_ms[indexOf(Method::kPlain)] = blurry_psnr;
  return frame;
}

Evaluation evaluationWith(const std::string& name, const std::vector<FrameFigures>& frames) {
  Evaluation evaluation;
  evaluation.name = name;
  evaluation.frames = frames;
  evaluation.example[indexOf(Method::kBlurry)] = texturedImage();
  evaluation.example[indexOf(Method::kPlain)] = texturedImage();
  return evaluation;
}

class ReportTest : public testing::Test {
 protected:
  static std::string contentOf(const fs::path& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  TemporaryDirectory directory_;
  std::string folder_ = directory_.file("report");
  Evaluation one_ = evaluationWith("one", {frameWith(20.0, 26.0), frameWith(22.0, 28.0)});
  Evaluation two_ = evaluationWith("two", {frameWith(30.0, 31.0)});
};

TEST_F(ReportTest, MeansCountEachMemberTheSame) {
  EXPECT_EQ(one_.mean(Method::kPlain, Measure::kPsnr), 27.0);
  EXPECT_EQ(meanOver({&one_, &two_}, indexOf(Method::kPlain), Measure::kPsnr), 29.0);
  EXPECT_FALSE(meanOver({&one_, &two_}, indexOf(Method::kOurs), Measure::kPsnr).has_value());
  EXPECT_EQ(one_.medianRuntimeMs(indexOf(Method::kPlain)), 22.0);
  EXPECT_EQ(one_.maxRuntimeMs(indexOf(Method::kPlain)), 22.0);
}

TEST_F(ReportTest, TablesHaveWhatWasMeasuredAndNothingElse) {
  std::ostringstream table;
  printMeasureTable(table, {"both", {&one_, &two_}});
  EXPECT_EQ(table.str(),
            "| mean | blurry input | plain EDI |\n"
            "|---|---:|---:|\n"
            "| PSNR [dB] | 25.50 | 29.00 |\n"
            "| inliers ORB | 40.0 | 50.0 (+25 %) |\n");
  std::ostringstream members;
  printMemberTable(members, {"both", {&one_, &two_}}, Measure::kPsnr);
  EXPECT_EQ(members.str(),
            "| recording | blurry input | plain EDI |\n"
            "|---|---:|---:|\n"
            "| one | 21.00 | 27.00 |\n"
            "| two | 30.00 | 31.00 |\n"
            "| mean | 25.50 | 29.00 |\n");
}

TEST_F(ReportTest, OtherMethodsStandBeforeTheTruth) {
  for (Evaluation* evaluation : {&one_, &two_}) {
    evaluation->others = {"theirs"};
    evaluation->example.resize(kMethodCount + 1);
    for (FrameFigures& frame : evaluation->frames) {
      frame.scores.resize(kMethodCount + 1);
      frame.runtime_ms.resize(kMethodCount + 1);
      frame.scores[kMethodCount][indexOf(Measure::kPsnr)] = 25.0;
      frame.scores[indexOf(Method::kTruth)][indexOf(Measure::kOrb)] = 60.0;
    }
  }
  std::ostringstream table;
  printMeasureTable(table, {"both", {&one_, &two_}});
  EXPECT_THAT(table.str(), HasSubstr("| mean | blurry input | plain EDI | theirs | truth |\n"));
  EXPECT_THAT(table.str(), HasSubstr("| PSNR [dB] | 25.50 | 29.00 | 25.00 | - |\n"));
  std::ostringstream runtimes;
  printRuntimeTable(runtimes, {"both", {&one_, &two_}});
  EXPECT_EQ(runtimes.str(),
            "| run time per frame [ms] | median | worst |\n"
            "|---|---:|---:|\n"
            "| plain EDI | 22.00 | 30.00 |\n")
      << "what was not computed here has no run time";
  writeReport(folder_, {}, {{"both", {&one_, &two_}}});
  EXPECT_THAT(contentOf(fs::path(folder_) / "figures.csv"), HasSubstr(",theirs,0,25,"));
}

TEST_F(ReportTest, ThePageNamesOnlyPicturesThatExist) {
  one_.left_out["no event stream"] = 2;
  const std::string page = writeReport(folder_, {"A title", "the command", {"a note"}},
                                       {{"first half", {&one_}}, {"second half", {&one_, &two_}}});
  const std::string text = contentOf(page);
  EXPECT_THAT(text, HasSubstr("# A title"));
  EXPECT_THAT(text, HasSubstr("the command"));
  EXPECT_THAT(text, HasSubstr("- a note"));
  EXPECT_THAT(text, HasSubstr("2 left out (no event stream)"));
  int pictures = 0;
  for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
    const std::size_t end = text.find(')', at);
    const fs::path picture = fs::path(folder_) / text.substr(at + 2, end - at - 2);
    EXPECT_FALSE(cv::imread(picture.string()).empty()) << picture;
    ++pictures;
  }
  EXPECT_EQ(pictures, 2 * 2 + 3);
  EXPECT_THAT(contentOf(fs::path(folder_) / "figures.csv"), HasSubstr("first half,one,0,"));
}

TEST_F(ReportTest, NamesAFolderThatCannotBeMade) {
  std::ofstream(folder_) << "a file in the way";
  const auto write = [&] { writeReport(folder_, {}, {{"all", {&one_}}}); };
  EXPECT_THAT(messageOf<std::runtime_error>(write), HasSubstr(folder_));
}

TEST(PlotTest, DrawsInSeriesColoursAndLeavesGaps) {
  const cv::Mat empty = linePlot({"t", "x", "y"}, {{"a", {std::nullopt, std::nullopt}}});
  const cv::Mat drawn = linePlot({"t", "x", "y"}, {{"a", {1.0, 2.0}}});
  ASSERT_EQ(empty.size(), drawn.size());
  EXPECT_GT(cv::norm(empty, drawn, cv::NORM_L1), 0.0);
  const cv::Mat bars = barPlot({"t", "", "y"}, {"g", "h"}, {{"a", {1.0, 3.0}}, {"b", {2.0, {}}}});
  EXPECT_EQ(bars.type(), CV_8UC3);
}

TEST(PlotTest, AHigherBarIsHigher) {
  const auto darkRows = [](double value) {
    const cv::Mat plot = barPlot({"", "", ""}, {""}, {{"", {value}}, {"", {10.0}}, {"", {0.0}}});
    cv::Mat grey;
    cv::cvtColor(plot, grey, cv::COLOR_BGR2GRAY);
    // Through the middle of the first of three bars.
    return cv::countNonZero(grey.col(80 + 900 / 4) < 200);
  };
  EXPECT_GT(darkRows(9.0), darkRows(3.0) + 100);
}

TEST(PictureGridTest, PlacesPicturesAndLeavesOutEmptyOnes) {
  const cv::Mat picture(10, 20, CV_8UC1, cv::Scalar(77));
  const cv::Mat grid = pictureGrid({{"", picture}, {"", cv::Mat()}, {"", picture}}, 2, 3);
  EXPECT_GE(grid.cols, 2 * 60);
  EXPECT_LT(grid.rows, 2 * 30);
  cv::Mat grey;
  cv::cvtColor(grid, grey, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(cv::countNonZero(grey == 77), 2 * 30 * 60);
}

}  // namespace
}  // namespace fast_edi
