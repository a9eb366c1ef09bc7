/// \file
/// A key of a configuration: its description, and how its value is read.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "config/config_faults.hpp"
#include "config/parameter_draft.hpp"
#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/config/parameter_table.hpp"

namespace fast_edi {

struct ConfigKey {
  ParameterDescription description;
  /// Reads a value into the draft; returns what was found and expected if it cannot, else nothing.
  std::function<std::string(const YAML::Node&, ParameterDraft&)> read;
  /// Keys of the map that is the value; empty for everything but maps, which need no read.
  std::vector<ConfigKey> members;
  /// Accepted besides the name.
  std::vector<std::string> other_spellings;
  /// Of a map: keys that may stand in it and mean nothing here. One that looks like a misspelt
  /// member is a fault all the same. Empty: there are none.
  std::function<bool(const std::string&)> is_foreign;
  /// Of a map: instead of it, the value may be the path of a YAML file that holds it.
  bool may_be_file = false;
};

/// What people need to know about a key besides its type and range.
struct KeyText {
  std::string name;
  std::string unit;
  std::string default_value;
  std::string doc;
};

/// "'0.3'", "a list", ...: what a message says was found.
std::string foundText(const YAML::Node& node);

/// "true" or "false".
std::string boolText(bool value);

ConfigKey numberKey(const KeyText& text, NumberRange range,
                    std::function<void(double, ParameterDraft&)> store);
/// Name, unit and range are those of \p parameter.
ConfigKey numberKey(const ParameterRange& parameter, const std::string& default_value,
                    const std::string& doc, std::function<void(double, ParameterDraft&)> store);
ConfigKey integerKey(const KeyText& text, NumberRange range,
                     std::function<void(std::int64_t, ParameterDraft&)> store);
ConfigKey integerKey(const ParameterRange& parameter, const std::string& default_value,
                     const std::string& doc,
                     std::function<void(std::int64_t, ParameterDraft&)> store);
ConfigKey boolKey(const KeyText& text, std::function<void(bool, ParameterDraft&)> store);
ConfigKey textKey(const KeyText& text,
                  std::function<void(const std::string&, ParameterDraft&)> store);
ConfigKey mapKey(const KeyText& text, std::vector<ConfigKey> members);

/// A key whose value is one of some words.
template <typename Choice>
ConfigKey choiceKey(const KeyText& text, std::vector<std::pair<std::string, Choice>> choices,
                    std::function<void(Choice, ParameterDraft&)> store) {
  std::string words;
  for (const auto& choice : choices) {
    words += (words.empty() ? "" : ", ") + choice.first;
  }
  ConfigKey key;
  key.description = {text.name, "choice", text.unit, words, text.default_value, text.doc};
  key.read = [choices = std::move(choices), words, store = std::move(store)](
                 const YAML::Node& node, ParameterDraft& draft) -> std::string {
    for (const auto& choice : choices) {
      if (node.IsScalar() && choice.first == node.Scalar()) {
        store(choice.second, draft);
        return {};
      }
    }
    return "found " + foundText(node) + ", expected one of: " + words;
  };
  return key;
}

/// Reads every entry of a map by the key of its name. Unknown and repeated keys are faults.
/// \param prefix of the keys in messages and in the draft, e.g. "biases/"
/// \param is_foreign see ConfigKey
void readMap(const YAML::Node& map, const std::vector<ConfigKey>& keys, const std::string& prefix,
             ParameterDraft& draft, ConfigFaults& faults,
             const std::function<bool(const std::string&)>& is_foreign = {});

}  // namespace fast_edi
