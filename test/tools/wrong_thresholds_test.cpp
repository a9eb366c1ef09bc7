/// Summaries of `deblur_bag` and of the demo say when contrast thresholds look wrong.
#include <fstream>
#include <string>

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
  /// Both summaries. \param factor on the thresholds that were simulated
  std::string summaries(double factor) const {
    std::ofstream(config_) << "contrast_threshold_on: " << 0.2609 * factor
                           << "\ncontrast_threshold_off: " << 0.2416 * factor << "\n";
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

}  // namespace
}  // namespace fast_edi
