#include "node/bias_update.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

using Ints = std::vector<std::pair<const char*, int>>;

dynamic_reconfigure::Config makeUpdate(const Ints& ints) {
  dynamic_reconfigure::Config update;
  for (const auto& [name, value] : ints) {
    dynamic_reconfigure::IntParameter parameter;
    parameter.name = name;
    parameter.value = value;
    update.ints.push_back(parameter);
  }
  return update;
}

/// libcaer's defaults for the DAVIS346: thresholds 0.260911, 0.241554.
const Ints kDavis346 = {{"DiffBn_coarse", 4}, {"DiffBn_fine", 39}, {"ONBn_coarse", 5},
                        {"ONBn_fine", 255},   {"OFFBn_coarse", 4}, {"OFFBn_fine", 1},
                        {"max_events", 0}};
constexpr double kOn = 0.260911;
constexpr double kOff = 0.241554;
constexpr double kTolerance = 1e-5;

LoadedParameters loadedWith(NeededThresholds from_biases) {
  LoadedParameters loaded;
  loaded.deblur.thresholds = {0.4, 0.5};
  loaded.from_biases = from_biases;
  return loaded;
}

TEST(BiasUpdate, ReplacesThresholdsThatCameFromBiases) {
  const auto update = thresholdsAfterBiasUpdate(loadedWith({true, true}), makeUpdate(kDavis346));
  ASSERT_TRUE(update);
  EXPECT_NEAR(update->thresholds.on, kOn, kTolerance);
  EXPECT_NEAR(update->thresholds.off, kOff, kTolerance);
}

TEST(BiasUpdate, LeavesExplicitThresholdsAlone) {
  const auto one = thresholdsAfterBiasUpdate(loadedWith({true, false}), makeUpdate(kDavis346));
  ASSERT_TRUE(one);
  EXPECT_NEAR(one->thresholds.on, kOn, kTolerance);
  EXPECT_EQ(one->thresholds.off, 0.5);
  EXPECT_FALSE(thresholdsAfterBiasUpdate(loadedWith({false, false}), makeUpdate(kDavis346)));
}

TEST(BiasUpdate, KeepsTheCapacitorRatioAndDropsTheConvention) {
  LoadedParameters loaded = loadedWith({true, true});
  loaded.biases.emplace();
  loaded.biases->convention = CoarseConvention::kJaerXml;
  loaded.biases->capacitor_ratio = 130.0 / 3.0;
  const auto update = thresholdsAfterBiasUpdate(loaded, makeUpdate(kDavis346));
  ASSERT_TRUE(update);
  EXPECT_NEAR(update->thresholds.on, kOn / 2.0, kTolerance);
}

TEST(BiasUpdate, IgnoresUpdatesWithoutBiases) {
  EXPECT_FALSE(
      thresholdsAfterBiasUpdate(loadedWith({true, true}), makeUpdate({{"max_events", 0}})));
}

TEST(BiasUpdate, RefusesAnIncompleteUpdate) {
  Ints ints = kDavis346;
  ints.erase(ints.begin() + 5);
  try {
    thresholdsAfterBiasUpdate(loadedWith({true, true}), makeUpdate(ints));
    FAIL() << "an update without OFFBn_fine was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("OFFBn_fine"), std::string::npos);
  }
  EXPECT_TRUE(thresholdsAfterBiasUpdate(loadedWith({true, false}), makeUpdate(ints)))
      << "OFFBn is not needed when the OFF threshold is explicit";
}

/// What davis_ros_driver reports when nobody changes its biases: OFFBn has no current.
const Ints kStockDriver = {{"DiffBn_coarse", 4}, {"DiffBn_fine", 39}, {"ONBn_coarse", 6},
                           {"ONBn_fine", 200},   {"OFFBn_coarse", 4}, {"OFFBn_fine", 0}};

TEST(BiasUpdate, TakesTheStockDriverForAsSensitiveToOffAsToOn) {
  const std::string folder = FAST_EDI_SOURCE_DIR "/cfg/";
  const auto update = thresholdsAfterBiasUpdate(parametersFromFile(folder + "davis346.yaml"),
                                                makeUpdate(kStockDriver));
  ASSERT_TRUE(update);
  const ContrastThresholds shipped =
      parametersFromFile(folder + "davis_ros_driver.yaml").deblur.thresholds;
  EXPECT_NEAR(update->thresholds.on, shipped.on, kTolerance);
  EXPECT_NEAR(update->thresholds.off, shipped.off, kTolerance);
  EXPECT_TRUE(update->off_assumed);
}

TEST(BiasUpdate, TakesAnExplicitOnThresholdForOffToo) {
  const auto update =
      thresholdsAfterBiasUpdate(loadedWith({false, true}), makeUpdate(kStockDriver));
  ASSERT_TRUE(update);
  EXPECT_EQ(update->thresholds.on, 0.4);
  EXPECT_EQ(update->thresholds.off, 0.4);
}

TEST(BiasUpdate, AssumesNothingWhereTheOffThresholdIsKnown) {
  const auto both = thresholdsAfterBiasUpdate(loadedWith({true, true}), makeUpdate(kDavis346));
  ASSERT_TRUE(both);
  EXPECT_FALSE(both->off_assumed);
  const auto given = thresholdsAfterBiasUpdate(loadedWith({true, false}), makeUpdate(kStockDriver));
  ASSERT_TRUE(given);
  EXPECT_EQ(given->thresholds.off, 0.5);
  EXPECT_FALSE(given->off_assumed);
}

TEST(BiasUpdate, RefusesAnOffBiasOutOfRangeWithoutCurrent) {
  Ints ints = kStockDriver;
  ints[4].second = 8;
  EXPECT_THROW(thresholdsAfterBiasUpdate(loadedWith({true, true}), makeUpdate(ints)),
               std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
