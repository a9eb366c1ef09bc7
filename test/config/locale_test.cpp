/// A nodelet shares its process with others, any of which may set a locale.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/config/live_parameters.hpp"
#include "fast_edi/config/parameter_table.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "support/comma_locale.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kThresholds = "contrast_threshold_on: 0.3\ncontrast_threshold_off: 0.25\n";
const std::string kBiases =
    "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 5, OnBn_fine: 255, "
    "OffBn_coarse: 4, OffBn_fine: 1, kappa_n: 0.7}\n";

TEST(Locale, ConfigurationsAreReadTheSame) {
  const testing::CommaLocale comma;
  const DeblurParameters parameters =
      parametersFromYaml(YAML::Load(kThresholds + "close_timeout_ms: 50.5\n"), "").deblur;
  EXPECT_EQ(parameters.thresholds, (ContrastThresholds{0.3, 0.25}));
  EXPECT_EQ(parameters.close_timeout_ns, 50'500'000);
  EXPECT_NEAR(parametersFromYaml(YAML::Load(kBiases), "").deblur.thresholds.on, 0.260911, 1e-5);
}

TEST(Locale, ANumberWithACommaIsNone) {
  const testing::CommaLocale comma;
  try {
    parametersFromYaml(YAML::Load(kThresholds + "close_timeout_ms: '50,5'\n"), "");
    ADD_FAILURE() << "50,5 was accepted";
  } catch (const ParameterError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("close_timeout_ms: found '50,5', expected a number 1..60000 [ms]"));
  }
}

TEST(Locale, MessagesTablesAndWarningsAreTheSame) {
  const std::string table = markdownTable(parameterDescriptions());
  const YAML::Node root = YAML::Load(kThresholds);
  LiveParameters live(parametersFromYaml(root, ""), root);
  const testing::CommaLocale comma;
  EXPECT_EQ(markdownTable(parameterDescriptions()), table);
  EXPECT_THAT(live.change({{"contrast_threshold_on", "12.5"}}),
              ElementsAre("contrast_threshold_on: found '12.5', expected a number 0.01..10 "
                          "[natural log], or 0 for the one from biases"));
  EXPECT_EQ(scalarText(0.35), "0.35");
  live.change({{"contrast_threshold_on", "0.9"}});
  EXPECT_THAT(live.loaded().warnings.front(), HasSubstr("is 0.9, usual are 0.05 to 0.6"));
}

}  // namespace
}  // namespace fast_edi
