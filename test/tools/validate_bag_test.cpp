/// The program `validate_bag`, run as a user runs it on simulated recordings.
#include <filesystem>
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using fast_edi::testing::CommandResult;
using fast_edi::testing::runCommand;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
const std::string kThresholds = " contrast_threshold_on:=0.2609 contrast_threshold_off:=0.2415";

class ValidateBagTest : public ::testing::Test {
 protected:
  std::string simulate(const std::string& options) {
    const std::string bag = directory_.file("recording.bag");
    const CommandResult result = runCommand(
        kTools + "simulate_davis --force --no-ground-truth --frames 9 --width 96 " +
        "--height 72 --motion pan --texture natural --seed 3 --out " + bag + " " + options);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return bag;
  }
  /// Simulates with \p options and validates.
  CommandResult validate(const std::string& options) {
    return runCommand(kTools + "validate_bag " + simulate(options) + kThresholds);
  }

  TemporaryDirectory directory_;
};

TEST_F(ValidateBagTest, HelpTellsTheExitCodes) {
  const CommandResult help = runCommand(kTools + "validate_bag --help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, HasSubstr("Exit code: 0 no findings; 1 failed; 2 findings"));
  EXPECT_EQ(runCommand(kTools + "validate_bag --nonsense").exit_code, 1);
  EXPECT_EQ(runCommand(kTools + "validate_bag /nonexistent.bag").exit_code, 1);
  EXPECT_EQ(runCommand(kTools + "validate_bag a.bag b.bag").exit_code, 1);
}

TEST_F(ValidateBagTest, AdviceFitsWhatMadeTheRecording) {
  const std::string bag = simulate("--fault suppress-on");
  const auto advice_for = [&](const std::string& recording) {
    return runCommand(kTools + "validate_bag " + recording + kThresholds).output;
  };
  const std::string of_bag = advice_for(bag);
  EXPECT_THAT(of_bag, HasSubstr("driver: polarity_suppress: false"));
  const std::string setting = "polarity_suppress";
  const std::pair<const char*, const char*> others[] = {
      {"recording.aedat4", "DV: events of both polarities"},
      {"recording.h5", "record and convert events of both polarities"}};
  for (const auto& [name, expected] : others) {
    SCOPED_TRACE(name);
    const std::string recording = directory_.file(name);
    ASSERT_EQ(runCommand(kTools + "convert_recording " + bag + " " + recording).exit_code, 0);
    EXPECT_THAT(advice_for(recording),
                AllOf(HasSubstr(expected), Not(HasSubstr("driver:")), Not(HasSubstr(setting))));
  }
}

TEST_F(ValidateBagTest, ASoundRecordingPassesAndIsDrawn) {
  const std::string bag = simulate("");
  const CommandResult result = runCommand(kTools + "validate_bag " + bag + kThresholds +
                                          " --output " + directory_.file("report"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("no findings; proposal:"),
                                   HasSubstr("stamp_reference: mid\ntime_offset_us: 0\n")));
  EXPECT_TRUE(std::filesystem::exists(directory_.file("report/shift.png")));
}

TEST_F(ValidateBagTest, OtherTopicNamesAreFound) {
  const CommandResult result = validate("--namespace /cam0");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output,
              HasSubstr("events /cam0/events, frames /cam0/image_raw, exposures /cam0/exposure"));
  const CommandResult missing =
      runCommand(kTools + "validate_bag " + directory_.file("recording.bag") + " --events /none " +
                 "--image /cam0/events");
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.output, HasSubstr("[topics]"));
}

TEST_F(ValidateBagTest, FaultsOfMessagesAreNamedWithTheSetting) {
  const CommandResult start = validate("--stamp start --fault start-near-1970");
  EXPECT_EQ(start.exit_code, 2);
  EXPECT_THAT(start.output, AllOf(HasSubstr("[timing]"), HasSubstr("[stamps-near-1970]"),
                                  HasSubstr("stamp_reference: start\n")));
  const CommandResult lossy =
      validate("--fault dropped-arrays --fault dropped-images --no-exposure");
  EXPECT_EQ(lossy.exit_code, 2);
  EXPECT_THAT(lossy.output, AllOf(HasSubstr("[arrays-dropped]"), HasSubstr("[event-holes]"),
                                  HasSubstr("[frames-dropped]"), HasSubstr("[exposure-missing]")));
  const CommandResult sizes = validate("--fault more-rows --fault repeated-stamp");
  EXPECT_THAT(sizes.output, AllOf(HasSubstr("[frame-size-changes]"), HasSubstr("[stamps-repeated]"),
                                  Not(HasSubstr("[arrays-dropped]"))));
}

TEST_F(ValidateBagTest, ADamagedRecordingIsReadAsFarAsItGoes) {
  const std::string bag = simulate("");
  std::filesystem::resize_file(bag, std::filesystem::file_size(bag) * 3 / 4);
  const CommandResult result = runCommand(kTools + "validate_bag " + bag + kThresholds);
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr("[file-damaged]"));
}

}  // namespace
}  // namespace fast_edi
