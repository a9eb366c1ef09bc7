/// The program `tune`, with a window in an X server of its own, and without one.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "fast_edi/config/parameters_from_yaml.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using fast_edi::testing::CommandResult;
using fast_edi::testing::runCommand;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
const std::string kPressKeys = std::string("'") + FAST_EDI_SOURCE_DIR + "/test/tools/press_keys' ";
const std::string kConfig = std::string(FAST_EDI_SOURCE_DIR) + "/cfg/davis346.yaml";

/// Keys that put the first slider into focus, which highgui leaves to its toolkit.
std::string firstSlider() {
  const std::regex qt(R"(QT:\s+YES)");
  return std::regex_search(cv::getBuildInformation(), qt) ? "Tab= Tab= " : "Tab= ";
}

class TuneTest : public ::testing::Test {
 protected:
  void simulate(const std::string& options) const {
    const CommandResult result =
        runCommand(kTools +
                   "simulate_davis --no-ground-truth --frames 9 --width 96 --height 72 "
                   "--motion pan --texture natural --seed 3 --out " +
                   bag_ + " " + options);
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  std::string tune(const std::string& options) const {
    return kTools + "tune " + bag_ + " --save " + saved_ + " " + options;
  }
  /// What the last line of the tool's output writes as frames.
  void runPrintedCommand(const std::string& output, const std::string& frames) const {
    const std::string tool = "rosrun fast_edi ";
    const std::size_t begin = output.rfind(tool);
    ASSERT_NE(begin, std::string::npos) << output;
    std::string command = output.substr(begin + tool.size());
    command.replace(command.find("--out deblurred.bag"), std::string("--out deblurred.bag").size(),
                    "--frames " + frames);
    const CommandResult result = runCommand(kTools + command.substr(0, command.find('\n')));
    EXPECT_EQ(result.exit_code, 0) << result.output;
  }

  TemporaryDirectory directory_;
  const std::string bag_ = directory_.file("recording.bag");
  const std::string saved_ = directory_.file("tuned.yaml");
  const std::string picture_ = directory_.file("tune.png");
};

TEST_F(TuneTest, KeysChangeWhatIsSaved) {
  simulate("");
  // Tab and the arrows are for the window's own slider, the others are keys of the tool.
  const CommandResult result = runCommand(
      kPressKeys + "'tune: frame 3, contrast_threshold_on 0.3$' " +
      "n='frame 4, contrast_threshold_on 0.3$' plus='contrast_threshold_on 0.307$' " +
      "greater='contrast_threshold_on 0.375$' " + firstSlider() +
      "Right= Right='frame 4, contrast_threshold_on 0.3[89]' j='contrast_threshold_off 0.2$' "
      "minus='contrast_threshold_off 0.195$' p='frame 3, ' x='h shows the keys' "
      "h='contrast_threshold_off 0.195$' s='saved to' q= -- " +
      tune("--config " + kConfig +
           " --frame 3 contrast_threshold_on:=0.3 contrast_threshold_off:=0.2"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("written: " + saved_),
                                   HasSubstr("deblur_bag --in " + bag_), HasSubstr(saved_)));
  const DeblurParameters loaded = parametersFromFile(saved_).deblur;
  EXPECT_GT(loaded.thresholds.on, 0.38);
  EXPECT_LT(loaded.thresholds.on, 0.4);
  EXPECT_EQ(loaded.thresholds.off, 0.195);
  EXPECT_FALSE(loaded.refine_contrast);
  runPrintedCommand(result.output, directory_.file("frames"));
  EXPECT_TRUE(fs::exists(directory_.file("frames/000008.png")));
}

TEST_F(TuneTest, EscapeEndsWithoutSaving) {
  simulate("");
  const CommandResult result =
      runCommand(kPressKeys + "'tune: frame 0, ' Left='first frame' Escape= -- " +
                 tune("--as-given --frame 0 --config " + kConfig));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_FALSE(fs::exists(saved_));
  EXPECT_THAT(result.output, AllOf(HasSubstr("--config " + kConfig),
                                   HasSubstr("refine_contrast:=false"), Not(HasSubstr("written"))));
}

TEST_F(TuneTest, AFileThatCannotBeWrittenEndsNothing) {
  simulate("");
  const std::string nowhere = directory_.file("none/tuned.yaml");
  const CommandResult result =
      runCommand(kPressKeys + "'tune: frame 0, ' s='cannot write' q= -- " + kTools + "tune " +
                 bag_ + " --as-given --frame 0 --config " + kConfig + " --save " + nowhere);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("cannot write " + nowhere));
}

TEST_F(TuneTest, WithoutADisplayItSaysWhatToDo) {
  simulate("");
  const CommandResult result = runCommand("env -u DISPLAY -u WAYLAND_DISPLAY " + tune(""));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, AllOf(HasSubstr("tune: no display"), HasSubstr("DISPLAY is not set"),
                                   HasSubstr("--screenshot FILE.png")));
}

TEST_F(TuneTest, StartsFromWhatIsProposed) {
  simulate("--fault invert-polarity --no-exposure");
  const CommandResult result = runCommand("env -u DISPLAY " + tune("--screenshot " + picture_));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("proposed by validate_bag: stamp_reference:="),
                    HasSubstr(" event_polarity:=inverted "), HasSubstr("written: " + picture_),
                    HasSubstr("contrast_threshold_on:=0."), HasSubstr("exposure_time_us:=")));
  const cv::Mat picture = cv::imread(picture_);
  EXPECT_GT(picture.cols, 3 * 96);
  runPrintedCommand(result.output, directory_.file("frames"));
}

TEST_F(TuneTest, GivenParametersComeFirst) {
  simulate("--stamp start");
  const std::string options = "--config " + kConfig + " --screenshot " + picture_ + " --force ";
  EXPECT_THAT(runCommand(tune(options + "stamp_reference:=end")).output,
              HasSubstr(" stamp_reference:=end "));
  const CommandResult as_given = runCommand(tune(options + "--as-given"));
  EXPECT_THAT(as_given.output,
              AllOf(Not(HasSubstr("proposed")), Not(HasSubstr("stamp_reference:="))));
}

TEST_F(TuneTest, RefusesFramesThatAreNotThere) {
  simulate("");
  const std::string options = "--as-given --config " + kConfig + " --screenshot " + picture_;
  const CommandResult beyond = runCommand(tune(options + " --frame 9"));
  EXPECT_EQ(beyond.exit_code, 1);
  EXPECT_THAT(beyond.output, HasSubstr("--frame 9, expected 0..8"));
  EXPECT_THAT(runCommand(tune(options + " --frame -1")).output, HasSubstr("expected a number"));
  EXPECT_EQ(runCommand(tune(options + " --image /dvs/events")).exit_code, 1);
  EXPECT_EQ(runCommand(kTools + "tune /nonexistent.bag --screenshot " + picture_).exit_code, 1);
  EXPECT_FALSE(fs::exists(picture_));
}

}  // namespace
}  // namespace fast_edi
