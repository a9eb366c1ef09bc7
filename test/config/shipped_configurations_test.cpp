/// Every file in cfg/ loads, says what it claims to say, and agrees with the code's defaults.
#include <gmock/gmock.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "fast_edi/config/parameter_table.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

using ::testing::IsEmpty;
using ::testing::UnorderedElementsAreArray;

constexpr double kTolerance = 1e-5;

struct Expectation {
  ContrastThresholds thresholds;
  std::string origin;
  /// Keys that are not at their default, besides the thresholds, and their values.
  std::map<std::string, std::string> others;
};

/// File name -> what is in force.
const std::map<std::string, Expectation> kShipped = {
    {"davis346.yaml", {{0.260911, 0.241554}, "biases", {}}},
    {"davis240c.yaml", {{0.231317, 0.237797}, "biases", {}}},
    {"davis_ros_driver.yaml", {{0.381999, 0.382}, "biases, contrast_threshold_off", {}}},
    {"dv_ros.yaml",
     {{0.260911, 0.241554},
      "biases",
      {{"stamp_reference", "start"}, {"exposure_source", "parameter"}}}},
};

std::string pathOf(const std::string& name) {
  return std::string(FAST_EDI_SOURCE_DIR) + "/cfg/" + name;
}

TEST(ShippedConfigurations, AreAllKnownHere) {
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(pathOf(""))) {
    if (entry.path().extension() == ".yaml") {
      found.insert(entry.path().filename().string());
    }
  }
  std::set<std::string> known;
  for (const auto& shipped : kShipped) {
    known.insert(shipped.first);
  }
  EXPECT_THAT(found, UnorderedElementsAreArray(known));
}

TEST(ShippedConfigurations, PutTheirThresholdsInForce) {
  for (const auto& [name, expected] : kShipped) {
    SCOPED_TRACE(name);
    const LoadedParameters loaded = parametersFromFile(pathOf(name));
    EXPECT_NEAR(loaded.deblur.thresholds.on, expected.thresholds.on, kTolerance);
    EXPECT_NEAR(loaded.deblur.thresholds.off, expected.thresholds.off, kTolerance);
    EXPECT_EQ(loaded.contrast_origin, expected.origin);
    EXPECT_THAT(loaded.warnings, IsEmpty());
  }
}

/// The value as the table of keys writes it.
std::string asDefault(const YAML::Node& value) {
  return value.Scalar().empty() ? "\"\"" : value.Scalar();
}

TEST(ShippedConfigurations, HaveEveryKeyAtItsDefaultButThoseTheyAreFor) {
  for (const auto& shipped : kShipped) {
    SCOPED_TRACE(shipped.first);
    const YAML::Node root = YAML::LoadFile(pathOf(shipped.first));
    for (const ParameterDescription& key : parameterDescriptions()) {
      if (key.name == "contrast_threshold_on" || key.name == "contrast_threshold_off" ||
          key.name == "biases") {
        continue;  // what the file is for
      }
      ASSERT_TRUE(root[key.name].IsDefined()) << key.name;
      const std::string value = asDefault(root[key.name]);
      const auto other = shipped.second.others.find(key.name);
      const std::string expected = other != shipped.second.others.end() ? other->second
                                   : key.default_value == "none"        ? "\"\""
                                                                        : key.default_value;
      EXPECT_EQ(value, expected) << key.name;
    }
    for (const ParameterDescription& key : biasDescriptions()) {
      if (key.default_value == "none") {
        continue;
      }
      const YAML::Node value = root["biases"][key.name];
      ASSERT_TRUE(value.IsDefined()) << key.name;
      if (key.type == "number") {
        EXPECT_NEAR(value.as<double>(), std::stod(key.default_value), 1e-4) << key.name;
      } else {
        EXPECT_EQ(value.Scalar(), key.default_value) << key.name;
      }
    }
  }
}

}  // namespace
}  // namespace fast_edi
