/// Summaries of `deblur_bag` and of the demo say when contrast thresholds look wrong, and
/// `validate_bag` proposes none of which they would say so.
#include <algorithm>
#include <fstream>
#include <regex>
#include <string>

#include <gmock/gmock.h>

#include "support/command.hpp"
#include "support/recordings.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using fast_edi::testing::CommandResult;
using fast_edi::testing::runCommand;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";

/// The parameters that validate_bag proposes for a recording: "name:=value name:=value ...".
/// \param arguments recording and parameters as given
std::string proposedParameters(const std::string& arguments) {
  const CommandResult report = runCommand(kTools + "validate_bag " + arguments);
  const std::size_t proposal = report.output.find("proposal:\n");
  EXPECT_NE(proposal, std::string::npos) << report.output;
  const std::string lines = report.output.substr(std::min(proposal, report.output.size()));
  const std::regex line(R"(\n(\w+): ([^\s#]+))");
  std::string parameters;
  for (std::sregex_iterator i(lines.begin(), lines.end(), line); i != std::sregex_iterator(); ++i) {
    // 0: the exposure topic has it.
    if (i->str(1) != "exposure_time_us" || i->str(2) != "0") {
      parameters += " " + i->str(1) + ":=" + i->str(2);
    }
  }
  return parameters;
}

/// Of thresholds as given, or against what was learned.
const auto kWarned = AnyOf(HasSubstr("look wrong"), HasSubstr("contrast threshold is"));

class WrongThresholds : public ::testing::Test {
 protected:
  void SetUp() override {
    const CommandResult result = runCommand(
        kTools +
        "simulate_davis --no-ground-truth --frames 20 --width 96 --height 72 --motion pan "
        "--texture natural --seed 3 --out " +
        bag_);
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  /// \param factor on the thresholds that were simulated
  void writeConfiguration(double factor) const {
    std::ofstream(config_) << "contrast_threshold_on: " << 0.2609 * factor
                           << "\ncontrast_threshold_off: " << 0.2416 * factor << "\n";
  }

  /// Both summaries. \param factor on the thresholds that were simulated
  std::string summaries(double factor) const {
    writeConfiguration(factor);
    const std::string output = directory_.file("out.bag");
    const CommandResult deblurred = runCommand(kTools + "deblur_bag --force --in " + bag_ +
                                               " --out " + output + " --config " + config_);
    EXPECT_EQ(deblurred.exit_code, 0) << deblurred.output;
    const CommandResult report =
        runCommand(kTools + "demo_report --force --in " + bag_ + " --live " + output +
                   " --config " + config_ + " --picture " + directory_.file("out.png"));
    EXPECT_EQ(report.exit_code, 0) << report.output;
    return deblurred.output + "report:\n" + report.output;
  }

  TemporaryDirectory directory_;
  const std::string bag_ = directory_.file("recording.bag");
  const std::string config_ = directory_.file("config.yaml");
};

TEST_F(WrongThresholds, AreNamedWithTheToolsThatHelp) {
  for (const double factor : {0.6, 1.8}) {
    const std::string text = summaries(factor);
    const std::string report = text.substr(text.find("report:\n"));
    for (const std::string& summary : {text.substr(0, text.find("report:\n")), report}) {
      EXPECT_THAT(summary, AllOf(HasSubstr("contrast thresholds look wrong"),
                                 HasSubstr("validate_bag measures them, tune sets them by eye")));
    }
  }
}

TEST_F(WrongThresholds, RightOnesAreNot) {
  EXPECT_THAT(summaries(1.0), Not(HasSubstr("look wrong")));
}

TEST_F(WrongThresholds, WhatIsProposedForThemIsNot) {
  for (const double factor : {0.6, 1.8}) {
    writeConfiguration(factor);
    const std::string parameters = proposedParameters(bag_ + " --config " + config_);
    ASSERT_THAT(parameters,
                AllOf(HasSubstr("contrast_threshold_on"), HasSubstr("contrast_threshold_off")));
    const CommandResult deblurred =
        runCommand(kTools + "deblur_bag --force --in " + bag_ + " --out " +
                   directory_.file("out.bag") + " --config " + config_ + parameters);
    EXPECT_EQ(deblurred.exit_code, 0) << deblurred.output;
    EXPECT_THAT(deblurred.output, Not(kWarned)) << parameters;
  }
}

TEST(WrongThresholdsOfRecordings, WhatIsProposedIsNotWarnedOf) {
  const TemporaryDirectory directory;
  for (const testing::NamedRecording& recording : testing::recordings()) {
    SCOPED_TRACE(recording.name);
    const std::string input = "'" + recording.path + "'";
    const std::string config =
        " --config '" + std::string(FAST_EDI_SOURCE_DIR) + "/cfg/davis346.yaml' ";
    const std::string parameters = proposedParameters(input + config + recording.parameters);
    const CommandResult deblurred = runCommand(kTools + "deblur_bag --in " + input + " --out " +
                                               directory.file(recording.name + ".bag") + config +
                                               recording.parameters + parameters);
    EXPECT_EQ(deblurred.exit_code, 0) << deblurred.output;
    EXPECT_THAT(deblurred.output, AllOf(HasSubstr("deblurred"), Not(kWarned))) << parameters;
  }
}

}  // namespace
}  // namespace fast_edi
