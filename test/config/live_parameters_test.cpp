#include "fast_edi/config/live_parameters.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/config/parameter_table.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kExplicit = "contrast_threshold_on: 0.3\ncontrast_threshold_off: 0.2\n";
const std::string kFromBiases =
    "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 5, OnBn_fine: 255, "
    "OffBn_coarse: 4, OffBn_fine: 1}\n";

LiveParameters startedWith(const std::string& yaml) {
  const YAML::Node root = YAML::Load(yaml);
  return {parametersFromYaml(root, ""), root};
}

ContrastThresholds thresholdsOf(const std::string& yaml) {
  return parametersFromYaml(YAML::Load(yaml), "").deblur.thresholds;
}

TEST(LiveParameters, BeginWithWhatWasGivenAndDefaults) {
  const LiveParameters live =
      startedWith(kExplicit + "exposure_time_us: 1e4\nreference: end\nlazy: false\n");
  EXPECT_EQ(live.values().at("contrast_threshold_on"), "0.3");
  EXPECT_EQ(live.values().at("exposure_time_us"), "1e4");
  EXPECT_EQ(live.values().at("reference"), "end");
  EXPECT_EQ(live.values().at("filter_gain_noise"), "0.18");
  EXPECT_EQ(live.values().count("lazy"), 0u);
  EXPECT_EQ(startedWith(kFromBiases).values().at("contrast_threshold_off"), "0");
}

TEST(LiveParameters, AreThoseThatTheTableCallsLive) {
  const LiveParameters live = startedWith(kExplicit);
  std::size_t count = 0;
  for (const ParameterDescription& key : parameterDescriptions()) {
    EXPECT_EQ(live.values().count(key.name) == 1, key.live) << key.name;
    count += key.live ? 1 : 0;
  }
  EXPECT_EQ(live.values().size(), count);
}

TEST(LiveParameters, TakeOverWhatCanBeUsed) {
  LiveParameters live = startedWith(kExplicit);
  EXPECT_THAT(live.change({{"contrast_threshold_on", "0.4"},
                           {"time_offset_us", "-250.5"},
                           {"stamp_reference", "start"},
                           {"filter", "false"},
                           {"latent_images", "7"}}),
              IsEmpty());
  const DeblurParameters& deblur = live.loaded().deblur;
  EXPECT_EQ(deblur.thresholds.on, 0.4);
  EXPECT_EQ(deblur.thresholds.off, 0.2);
  EXPECT_EQ(deblur.time_offset_ns, -250'500);
  EXPECT_EQ(deblur.stamp_reference, ExposureInstant::kStart);
  EXPECT_FALSE(deblur.filter.enabled);
  EXPECT_EQ(deblur.latent.per_exposure, 7);
  EXPECT_EQ(live.values().at("time_offset_us"), "-250.5");
}

/// As the nodelet would start with them: the ranges are the same.
TEST(LiveParameters, AcceptWhatAStartAccepts) {
  for (const ParameterDescription& key : parameterDescriptions()) {
    if (!key.live || !key.limits) {
      continue;
    }
    const NumberRange& limits = *key.limits;
    for (const double value :
         {limits.lowest, limits.highest, limits.lowest - 1.0, limits.highest + 1.0,
          std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      const std::string text = scalarText(value);
      SCOPED_TRACE(key.name + " " + text);
      YAML::Node root = YAML::Load(kExplicit);
      root[key.name] = text;
      bool starts = true;
      try {
        parametersFromYaml(root, "");
      } catch (const ParameterError&) {
        starts = false;
      }
      LiveParameters live = startedWith(kExplicit);
      const LiveParameters::Values before = live.values();
      EXPECT_EQ(live.change({{key.name, text}}).empty(), starts);
      EXPECT_EQ(live.values().at(key.name), starts ? text : before.at(key.name));
    }
  }
}

TEST(LiveParameters, ARefusedValueLeavesTheOldOneAndNotTheOthers) {
  LiveParameters live = startedWith(kExplicit);
  EXPECT_THAT(
      live.change({{"contrast_threshold_off", "-0.2"},
                   {"exposure_time_us", "15000"},
                   {"reference", "middle"},
                   {"passthrough", "2"},
                   {"weighting", "counter"},
                   {"contrast", "0.3"}}),
      ElementsAre("contrast: found '0.3', expected a parameter that can be changed without a new "
                  "start",
                  "contrast_threshold_off: found '-0.2', expected a number 0.01..10 [natural "
                  "log], or 0 for the one from biases",
                  "passthrough: found '2', expected true or false",
                  "reference: found 'middle', expected one of: start, mid, end",
                  "weighting: found 'counter', expected a parameter that can be changed without a "
                  "new start"));
  EXPECT_EQ(live.loaded().deblur.thresholds.off, 0.2);
  EXPECT_EQ(live.values().at("contrast_threshold_off"), "0.2");
  EXPECT_EQ(live.loaded().deblur.reference, ExposureInstant::kMid);
  EXPECT_EQ(live.loaded().deblur.exposure_time_ns, 15'000'000);
  EXPECT_EQ(live.loaded().deblur.weighting, Weighting::kTime);
  EXPECT_EQ(live.values().count("weighting"), 0u);
}

TEST(LiveParameters, AThresholdIsExplicitOrFromBiases) {
  LiveParameters live = startedWith(kFromBiases);
  const ContrastThresholds derived = thresholdsOf(kFromBiases);
  EXPECT_THAT(live.change({{"contrast_threshold_on", "0.5"}}), IsEmpty());
  EXPECT_EQ(live.loaded().deblur.thresholds.on, 0.5);
  EXPECT_EQ(live.loaded().deblur.thresholds.off, derived.off);
  EXPECT_FALSE(live.loaded().from_biases.on);
  EXPECT_TRUE(live.loaded().from_biases.off);
  EXPECT_EQ(live.loaded().contrast_origin, "biases, contrast_threshold_on");

  EXPECT_THAT(live.change({{"contrast_threshold_on", "0.0"}}), IsEmpty());
  EXPECT_EQ(live.loaded().deblur.thresholds, derived);
  EXPECT_TRUE(live.loaded().from_biases.on);
  EXPECT_EQ(live.loaded().contrast_origin, "biases");
}

TEST(LiveParameters, AThresholdFromBiasesTakesBiases) {
  LiveParameters without = startedWith(kExplicit);
  EXPECT_THAT(without.change({{"contrast_threshold_on", "0"}}),
              ElementsAre("contrast_threshold_on: found '0', which means from biases; expected a "
                          "number > 0, since the configuration has no biases"));
  EXPECT_EQ(without.loaded().deblur.thresholds.on, 0.3);
  EXPECT_EQ(without.values().at("contrast_threshold_on"), "0.3");

  LiveParameters stock = startedWith(
      "contrast_threshold_off: 0.2\n"
      "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 6, OnBn_fine: 200, "
      "OffBn_coarse: 4, OffBn_fine: 0}\n");
  EXPECT_THAT(stock.change({{"contrast_threshold_off", "0"}}),
              ElementsAre(HasSubstr("contrast_threshold_off: found '0', which means from biases")));
  EXPECT_EQ(stock.loaded().deblur.thresholds.off, 0.2);
  EXPECT_FALSE(stock.loaded().from_biases.off);
}

TEST(LiveParameters, WarnOfUnusualThresholds) {
  LiveParameters live = startedWith(kExplicit);
  EXPECT_THAT(live.loaded().warnings, IsEmpty());
  live.change({{"contrast_threshold_on", "0.9"}});
  EXPECT_EQ(live.loaded().warnings.size(), 2u);
}

TEST(ScalarText, IsReadBackTheSame) {
  for (const double value : {0.1, 0.3, 1.0 / 3.0, 130.0 / 6.0, -3e15, 6.02214076e23, 1e-300}) {
    EXPECT_EQ(YAML::Node(scalarText(value)).as<double>(), value);
  }
  EXPECT_EQ(scalarText(0.3), "0.3");
  EXPECT_EQ(scalarText(10000.0), "10000");
  EXPECT_TRUE(std::isnan(YAML::Node(scalarText(std::nan(""))).as<double>()));
  EXPECT_EQ(YAML::Node(scalarText(-INFINITY)).as<double>(), -INFINITY);
  EXPECT_EQ(YAML::Node(scalarText(INFINITY)).as<double>(), INFINITY);
}

}  // namespace
}  // namespace fast_edi
