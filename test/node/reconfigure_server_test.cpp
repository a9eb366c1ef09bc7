// The two descriptions of live parameters: the one table of keys, and the one that
// dynamic_reconfigure generates its class from.
#include "node/reconfigure_server.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/DeblurConfig.h"
#include "fast_edi/config/parameter_table.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAreArray;

std::vector<ParameterDescription> liveParameters() {
  std::vector<ParameterDescription> live;
  for (const ParameterDescription& key : parameterDescriptions()) {
    if (key.live) {
      live.push_back(key);
    }
  }
  return live;
}

const DeblurConfig::AbstractParamDescription& described(const std::string& name) {
  const auto& all = DeblurConfig::__getParamDescriptions__();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&name](const auto& entry) { return entry->name == name; });
  if (found == all.end()) {
    throw std::runtime_error(name + " is not in cfg/Deblur.cfg");
  }
  return **found;
}

std::map<std::string, double> numbersOf(const DeblurConfig& config) {
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  std::map<std::string, double> numbers;
  for (const auto& entry : message.doubles) {
    numbers[entry.name] = entry.value;
  }
  for (const auto& entry : message.ints) {
    numbers[entry.name] = entry.value;
  }
  return numbers;
}

/// Defaults as text, those of thresholds aside.
std::map<std::string, std::string> defaultsOf(const DeblurConfig& config) {
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  std::map<std::string, std::string> texts;
  for (const auto& entry : message.bools) {
    texts[entry.name] = entry.value != 0 ? "true" : "false";
  }
  for (const auto& entry : message.strs) {
    texts[entry.name] = entry.value;
  }
  for (const auto& [name, value] : numbersOf(config)) {
    texts[name] = scalarText(value);
  }
  return texts;
}

TEST(DeblurConfig, HasTheLiveParametersInTheirOrder) {
  std::vector<std::string> expected;
  for (const ParameterDescription& key : liveParameters()) {
    expected.push_back(key.name);
  }
  std::vector<std::string> names;
  for (const auto& entry : DeblurConfig::__getParamDescriptions__()) {
    names.push_back(entry->name);
  }
  EXPECT_THAT(names, ElementsAreArray(expected));
}

TEST(DeblurConfig, HasTheirTypesAndTexts) {
  const std::map<std::string, std::string> type_names = {
      {"number", "double"}, {"integer", "int"}, {"bool", "bool"}, {"choice", "str"}};
  for (const ParameterDescription& key : liveParameters()) {
    SCOPED_TRACE(key.name);
    EXPECT_EQ(described(key.name).type, type_names.at(key.type));
    EXPECT_EQ(described(key.name).description,
              key.doc + (key.unit.empty() ? "" : " [" + key.unit + "]"));
  }
}

TEST(DeblurConfig, HasTheirRanges) {
  const auto lowest = numbersOf(DeblurConfig::__getMin__());
  const auto highest = numbersOf(DeblurConfig::__getMax__());
  for (const ParameterDescription& key : liveParameters()) {
    SCOPED_TRACE(key.name);
    ASSERT_EQ(key.limits.has_value(), key.type == "number" || key.type == "integer");
    if (key.limits) {
      // A threshold of 0 is the one from biases.
      const bool or_zero = key.limits->or_zero || key.name.rfind("contrast_threshold_", 0) == 0;
      EXPECT_EQ(lowest.at(key.name), or_zero ? 0.0 : key.limits->lowest);
      EXPECT_EQ(highest.at(key.name), key.limits->highest);
    }
  }
}

TEST(DeblurConfig, HasTheirChoices) {
  for (const ParameterDescription& key : liveParameters()) {
    SCOPED_TRACE(key.name);
    const std::string edit_method = described(key.name).edit_method;
    if (key.type != "choice") {
      EXPECT_EQ(edit_method, "");
      continue;
    }
    std::string words;
    const std::string before = "'value': '";
    for (std::size_t at = edit_method.find(before); at != std::string::npos;
         at = edit_method.find(before, at + 1)) {
      const std::size_t begin = at + before.size();
      words += (words.empty() ? "" : ", ") +
               edit_method.substr(begin, edit_method.find('\'', begin) - begin);
    }
    EXPECT_EQ(words, key.range);
  }
}

TEST(DeblurConfig, HasTheirDefaults) {
  const auto defaults = defaultsOf(DeblurConfig::__getDefault__());
  for (const ParameterDescription& key : liveParameters()) {
    // "from `biases`" is 0 there.
    EXPECT_EQ(defaults.at(key.name), key.default_value == "from `biases`" ? "0" : key.default_value)
        << key.name;
  }
}

}  // namespace
}  // namespace fast_edi
