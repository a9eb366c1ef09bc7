/// The program `contrast_from_bias`, run as a user runs it.
#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/contrast_from_bias ";
const std::string kConfigurations = std::string(FAST_EDI_SOURCE_DIR) + "/cfg/";

TEST(ContrastFromBiasTool, PrintsCurrentsGainAndThresholds) {
  const auto result = testing::runCommand(kTool + kConfigurations + "davis346.yaml");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(
      result.output,
      AllOf(ContainsRegex("DiffBn +4 +39 +7.408012e-09"),
            ContainsRegex("OnBn +5 +255 +3.875000e-07"), ContainsRegex("OffBn +4 +1 +1.899490e-10"),
            HasSubstr("= 0.0659341"), ContainsRegex("C_ON +0.260911 +from biases"),
            ContainsRegex("C_OFF +-0.241554 +from biases")));
}

TEST(ContrastFromBiasTool, ReadsAFileOfTheDriver) {
  const TemporaryDirectory directory;
  std::ofstream(directory.file("indoors.yaml"))
      << "{DiffBn_coarse: 2, DiffBn_fine: 39, OFFBn_coarse: 1, OFFBn_fine: 62, ONBn_coarse: 4,\n"
         "  ONBn_fine: 200, PrBp_coarse: 3, PrBp_fine: 72, exposure: 4000, streaming_rate: 30}\n";
  const auto result = testing::runCommand(kTool + directory.file("indoors.yaml"));
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(ContainsRegex("C_ON +0.382070 +from biases"),
                                   ContainsRegex("C_OFF +-0.106891 +from biases")));
}

TEST(ContrastFromBiasTool, TakesValuesInPlaceOfTheFiles) {
  const auto result =
      testing::runCommand(kTool + kConfigurations + "davis346.yaml contrast_threshold_on:=0.7");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output, AllOf(ContainsRegex("C_ON +0.700000 +given"),
                                   HasSubstr("warning: the ON contrast threshold is 0.7")));
}

TEST(ContrastFromBiasTool, RefusesABadConfiguration) {
  const auto zero =
      testing::runCommand(kTool + kConfigurations + "davis346.yaml biases/OffBn_fine:=0");
  EXPECT_EQ(zero.exit_code, 1);
  EXPECT_THAT(zero.output, HasSubstr("give contrast_threshold_off"));
  const auto missing = testing::runCommand(kTool + "/nonexistent.yaml");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.output, HasSubstr("/nonexistent.yaml: cannot be read"));
}

TEST(ContrastFromBiasTool, ExplainsItself) {
  const auto help = testing::runCommand(kTool + "--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, HasSubstr("Usage: contrast_from_bias FILE.yaml"));
}

}  // namespace
}  // namespace fast_edi
