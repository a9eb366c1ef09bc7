#include "node/parameters_in_force.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kBiases[] =
    "{biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 5, OnBn_fine: 255, OffBn_coarse: 4,"
    " OffBn_fine: 1, coarse_convention: libcaer}}";
/// Of these biases.
constexpr double kOn = 0.260911;
constexpr double kTolerance = 1e-5;

dynamic_reconfigure::ConfigConstPtr makeUpdate(int diff_fine, int off_fine = 1) {
  auto update = boost::make_shared<dynamic_reconfigure::Config>();
  const std::vector<std::pair<const char*, int>> ints = {
      {"DiffBn_coarse", 4}, {"DiffBn_fine", diff_fine}, {"ONBn_coarse", 5},
      {"ONBn_fine", 255},   {"OFFBn_coarse", 4},        {"OFFBn_fine", off_fine}};
  for (const auto& [name, value] : ints) {
    update->ints.emplace_back();
    update->ints.back().name = name;
    update->ints.back().value = value;
  }
  return update;
}

class ParametersInForceTest : public ::testing::Test {
 protected:
  ParametersInForce make(const std::string& yaml) {
    return {YAML::Load(yaml), "/node", "/biases", [this](const DeblurParameters& parameters) {
              if (!failure_.empty()) {
                throw std::invalid_argument(failure_);
              }
              applied_.push_back(parameters);
            }};
  }

  std::vector<DeblurParameters> applied_;
  std::string failure_;
};

TEST_F(ParametersInForceTest, ThresholdsFollowTheBiasesOfTheDriver) {
  ParametersInForce parameters = make(kBiases);
  const double before = parameters.get().deblur.thresholds.on;
  EXPECT_NEAR(before, kOn, kTolerance);
  EXPECT_EQ(parameters.followBiases(makeUpdate(39)), "");
  EXPECT_TRUE(applied_.empty());  // the same thresholds
  EXPECT_EQ(parameters.followBiases(makeUpdate(60)), "");
  ASSERT_EQ(applied_.size(), 1);
  EXPECT_LT(applied_[0].thresholds.on, before);
  EXPECT_EQ(parameters.get().deblur.thresholds, applied_[0].thresholds);
  EXPECT_EQ(parameters.get().contrast_origin, "biases on /biases");
}

TEST_F(ParametersInForceTest, KeepsThemForBiasesWithoutAThreshold) {
  ParametersInForce parameters = make(kBiases);
  EXPECT_EQ(parameters.followBiases(makeUpdate(60)), "");
  const ContrastThresholds before = parameters.get().deblur.thresholds;
  EXPECT_NE(parameters.followBiases(makeUpdate(0)), "");
  EXPECT_EQ(parameters.get().deblur.thresholds, before);
  // What follows is combined with the last biases that could be used.
  EXPECT_EQ(parameters.change({{"weighting", "counter"}}).biases, "");
  EXPECT_EQ(parameters.get().deblur.thresholds, before);
}

TEST_F(ParametersInForceTest, SayThatTheOffThresholdOfADriverWithoutOneIsAssumed) {
  ParametersInForce parameters = make(kBiases);
  constexpr int kNoCurrent = 0;
  EXPECT_EQ(parameters.followBiases(makeUpdate(39, kNoCurrent)), "");
  const ContrastThresholds thresholds = parameters.get().deblur.thresholds;
  EXPECT_NEAR(thresholds.on, kOn, kTolerance);
  EXPECT_EQ(thresholds.off, thresholds.on);
  EXPECT_EQ(parameters.get().contrast_origin, "biases on /biases, OFF assumed to be as ON");
  EXPECT_THAT(parameters.get().warnings, ElementsAre(HasSubstr("set OFFBn_fine above 0")));
  EXPECT_EQ(parameters.followBiases(makeUpdate(39)), "");
  EXPECT_NE(parameters.get().deblur.thresholds.off, thresholds.off);
  EXPECT_EQ(parameters.get().contrast_origin, "biases on /biases");
  EXPECT_THAT(parameters.get().warnings, ::testing::IsEmpty());
}

TEST_F(ParametersInForceTest, ExplicitThresholdsTakePrecedence) {
  ParametersInForce parameters = make("{contrast_threshold_on: 0.4, contrast_threshold_off: 0.5}");
  EXPECT_EQ(parameters.followBiases(makeUpdate(60)), "");
  EXPECT_TRUE(applied_.empty());
  EXPECT_EQ(parameters.get().deblur.thresholds.on, 0.4);
}

TEST_F(ParametersInForceTest, PutsInForceWhatIsNotRefused) {
  ParametersInForce parameters = make(kBiases);
  const auto refusals =
      parameters.change({{"contrast_threshold_on", "-1"}, {"passthrough", "true"}});
  EXPECT_THAT(refusals.values, ElementsAre(HasSubstr("contrast_threshold_on")));
  EXPECT_EQ(refusals.request, "");
  ASSERT_EQ(applied_.size(), 1);
  EXPECT_TRUE(applied_[0].passthrough);
  EXPECT_EQ(parameters.values().at("passthrough"), "true");
}

TEST_F(ParametersInForceTest, KeepsAllValuesOfARequestThatThePipelineRefuses) {
  ParametersInForce parameters = make(kBiases);
  failure_ = "no room";
  EXPECT_EQ(parameters.change({{"passthrough", "true"}}).request, "no room");
  EXPECT_FALSE(parameters.get().deblur.passthrough);
  EXPECT_EQ(parameters.values().at("passthrough"), "false");
}

}  // namespace
}  // namespace fast_edi
