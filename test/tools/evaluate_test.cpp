/// The program `evaluate`, run as a user runs it.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "networks/onnx_model.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using fast_edi::testing::CommandResult;
using fast_edi::testing::runCommand;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/evaluate ";
const std::string kDemo = FAST_EDI_SOURCE_DIR "/bags/demo.bag";
const std::string kThresholds = " contrast_threshold_on:=0.2609 contrast_threshold_off:=0.2415";

std::string contentOf(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class EvaluateTest : public ::testing::Test {
 protected:
  /// A short recording with truth.
  std::string simulate(const std::string& options = "") {
    const std::string bag = directory_.file("short.bag");
    const CommandResult result =
        runCommand(std::string(FAST_EDI_TOOLS_DIR) + "/simulate_davis --out " + bag +
                   " --frames 3 --seed 5 " + options);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return bag;
  }
  CommandResult evaluate(const std::string& arguments) const {
    return runCommand(kTool + arguments + " --output " + directory_.file("report"));
  }

  TemporaryDirectory directory_;
};

TEST_F(EvaluateTest, HelpNamesWhatItTakes) {
  const CommandResult result = runCommand(kTool + "--help");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("--sequences"));
  EXPECT_THAT(result.output, HasSubstr("--sseq-model"));
}

TEST_F(EvaluateTest, ARecordingWithTruthGivesTableAndPage) {
  const CommandResult result = evaluate(simulate() + kThresholds);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("| PSNR [dB] |"));
  EXPECT_THAT(result.output, HasSubstr("| inliers ORB |"));
  EXPECT_THAT(result.output, HasSubstr("Not measured: SSEQ: no model folder was given"));
  const std::string page = contentOf(directory_.file("report/report.md"));
  EXPECT_THAT(page, HasSubstr("short.bag: 3 frames compared"));
  EXPECT_THAT(page, HasSubstr("rosrun fast_edi evaluate"));
  EXPECT_TRUE(std::filesystem::exists(directory_.file("report/example_short_bag.png")));
}

TEST_F(EvaluateTest, ReplacesAReportOnlyWhenToldAndThenAllOfIt) {
  const std::string options = simulate() + kThresholds + " --full-reference-only";
  ASSERT_EQ(evaluate(options).exit_code, 0);
  std::ofstream(directory_.file("report/notes.txt")) << "mine";
  const std::string other = directory_.file("other.bag");
  std::filesystem::copy_file(directory_.file("short.bag"), other);
  const std::string other_options = other + kThresholds + " --full-reference-only";
  const CommandResult refused = evaluate(other_options);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("exists already (--force replaces it)"));
  EXPECT_THAT(contentOf(directory_.file("report/report.md")), HasSubstr("short.bag"));
  ASSERT_EQ(evaluate(other_options + " --force").exit_code, 0);
  EXPECT_THAT(contentOf(directory_.file("report/report.md")), HasSubstr("other.bag"));
  EXPECT_FALSE(std::filesystem::exists(directory_.file("report/example_short_bag.png")));
  EXPECT_TRUE(std::filesystem::exists(directory_.file("report/example_other_bag.png")));
  EXPECT_TRUE(std::filesystem::exists(directory_.file("report/notes.txt")));
}

TEST_F(EvaluateTest, WithoutTruthItSaysSo) {
  const CommandResult result =
      evaluate(simulate() + kThresholds + " --truth /none --full-reference-only");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("No true frames on /none: no PSNR, no SSIM"));
  EXPECT_THAT(result.output, Not(HasSubstr("| PSNR")));
}

TEST_F(EvaluateTest, MethodsAreJudgedAtTheInstantThatTheParameterNames) {
  const std::string options = kThresholds + " --full-reference-only --force";
  const CommandResult start = evaluate(simulate("--truth start") + options + " reference:=start");
  ASSERT_EQ(start.exit_code, 0) << start.output;
  EXPECT_THAT(start.output, HasSubstr("| PSNR [dB] |"));
  EXPECT_THAT(start.output, Not(HasSubstr("without a true frame")));
  const CommandResult middle = evaluate(directory_.file("short.bag") + options);
  ASSERT_EQ(middle.exit_code, 0) << middle.output;
  EXPECT_THAT(middle.output, Not(HasSubstr("| PSNR [dB] |")));
  EXPECT_THAT(middle.output, HasSubstr("3 frames without a true frame on "
                                       "/dvs/ground_truth/image_raw that has the stamp"));
}

TEST_F(EvaluateTest, FramesOfAnotherProgramAreAColumn) {
  const std::string bag = simulate();
  const std::string out = directory_.file("out.bag");
  {
    // The true frames but the last.
    rosbag::Bag source(bag, rosbag::bagmode::Read);
    rosbag::Bag target(out, rosbag::bagmode::Write);
    int frames = 0;
    for (const rosbag::MessageInstance& message :
         rosbag::View(source, rosbag::TopicQuery("/dvs/ground_truth/image_raw"))) {
      if (++frames < 3) {
        target.write("/theirs", message.getTime(), message);
      }
    }
  }
  const std::string options = bag + kThresholds + " --full-reference-only --column ";
  const CommandResult result = evaluate(options + "theirs=" + out + ":/theirs");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("| searched contrast | ours | theirs |\n"));
  EXPECT_THAT(result.output, HasSubstr(" | 100.00 |\n")) << "PSNR of the true frames themselves";
  EXPECT_THAT(result.output, HasSubstr("theirs: no frame in " + out + " /theirs at "));
  EXPECT_THAT(contentOf(directory_.file("report/figures.csv")), HasSubstr(",theirs,0,"));

  const auto fails = [&](const std::string& column, const std::string& message) {
    const CommandResult failed = evaluate(options + column + " --force");
    EXPECT_EQ(failed.exit_code, 1) << column;
    EXPECT_THAT(failed.output, HasSubstr(message));
  };
  fails("theirs", "--column: expected NAME=FILE, got \"theirs\"");
  fails("ours=" + out + ":/theirs", "there is a column \"ours\" already");
  fails("theirs=" + out, "no frames on /dvs/deblurred/image_raw; topics with images: /theirs");
  fails("theirs=/nonexistent.bag", "/nonexistent.bag");
  EXPECT_TRUE(std::filesystem::exists(directory_.file("report/report.md")))
      << "what cannot be done replaces nothing";
}

TEST_F(EvaluateTest, MethodsOfASingleImageAreColumnsOfTheFramesThatAreScored) {
  const std::string model = directory_.file("net.onnx");
  std::ofstream(model, std::ios::binary) << ConvolutionModel().bytes();
  const CommandResult result = evaluate(
      simulate() + kThresholds + " --full-reference-only --score-frames 2 --network same=" + model +
      " --dark-channel --dark-channel-kernel 5 --dark-channel-iterations 1");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("| searched contrast | ours | dark channel | same |\n"));
  EXPECT_THAT(result.output, HasSubstr("\n| same | "));
  EXPECT_THAT(contentOf(directory_.file("report/report.md")), HasSubstr(": 1 frames compared"));
}

TEST_F(EvaluateTest, ACutRecordingIsEvaluatedAsFarAsItGoes) {
  const std::string bag = simulate();
  std::filesystem::resize_file(bag, std::filesystem::file_size(bag) * 4 / 5);
  const CommandResult result = evaluate(bag + kThresholds + " --full-reference-only");
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr("warning: " + bag));
}

TEST_F(EvaluateTest, SequencesAreReportedByHalves) {
  const CommandResult result =
      evaluate("--sequences twelve --frames 1 --seeds 1 --full-reference-only");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("sequences for tuning"));
  EXPECT_THAT(result.output, HasSubstr("sequences not tuned on"));
  EXPECT_THAT(result.output, HasSubstr("| page-spin/1 |"));
}

TEST_F(EvaluateTest, ShowsTheVideoOverTheExposure) {
  const CommandResult result = evaluate("--sequences twelve --frames 1 --seeds 1 --video 3");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("| PSNR [dB] at | 0.17 | 0.50 | 0.83 | loss | largest |"));
  EXPECT_THAT(result.output, HasSubstr("| page-spin/1 |"));
}

TEST_F(EvaluateTest, SetsKnowTheirOptions) {
  const auto fails = [this](const std::string& arguments, const std::string& message) {
    const CommandResult result = evaluate(arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_THAT(result.output, HasSubstr(message));
  };
  fails("--sequences thirteen", "expected twelve, choosing or judging");
  fails("--sequences twelve --variant 'wide filter_gain_noise:=0.5'", "--variant goes with");
  fails("--sequences choosing --variant filter_gain_noise:=0.5", "expected a name");
  fails("--sequences choosing --measures some", "expected one of reference, tracks");
}

TEST_F(EvaluateTest, NamesWhatIsWrong) {
  const auto fails = [this](const std::string& arguments, const std::string& message) {
    const CommandResult result = evaluate(arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_THAT(result.output, HasSubstr(message));
  };
  fails("", "expected either a BAG or --sequences");
  fails("a.bag b.bag" + kThresholds, "a.bag");
  fails("/nonexistent.bag" + kThresholds, "/nonexistent.bag");
  fails(kDemo, "contrast_threshold_on");
  fails("--sequences twelve --frames 0", "at least one frame");
  fails("--sequences twelve --video 4", "expected an odd number");
  fails("a.bag --video 5" + kThresholds, "--video goes with --sequences twelve");
  fails("--sequences twelve --threshold-factor 0", "--threshold-factor");
  fails("--sequences twelve --column a=b.bag", "--column goes with a recording");
  fails("--sequences judging --dark-channel", "go with a recording or --sequences twelve");
  fails("a.bag --score-frames 0" + kThresholds, "expected numbers from 1 on and ranges");
  fails(kDemo + kThresholds + " --dark-channel --dark-channel-kernel 4", "odd side");
  fails(kDemo + kThresholds + " --network a=/nonexistent.onnx",
        "/nonexistent.onnx: cannot be read");
  fails(kDemo + kThresholds + " --network a.onnx", "--network: expected NAME=FILE");
  fails(kDemo + kThresholds + " --network-range 1", "expected BLACK:WHITE");
  fails("--sequences twelve --sseq-model /nonexistent", "/nonexistent/feature_range.txt");
  const std::string bag = simulate();
  fails(bag + kThresholds + " --image /none", "/none");
}

}  // namespace
}  // namespace fast_edi
