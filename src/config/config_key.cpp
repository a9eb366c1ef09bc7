#include "config/config_key.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "config/config_file.hpp"
#include "config/nearest_key.hpp"
#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

/// Names within this editDistance() are one meant for the other: two neighbouring letters swapped,
/// one letter replaced, two left out or added.
constexpr std::size_t kMisspelling = 4;

/// Nothing for infinities and NaN, which no range has.
std::optional<double> asNumber(const YAML::Node& node) {
  // Not by yaml-cpp, which reads as the locale says.
  return node.IsScalar() ? parseNumber(node.Scalar()) : std::nullopt;
}

std::string expected(const YAML::Node& node, const std::string& what) {
  return "found " + foundText(node) + ", expected " + what;
}

bool answersTo(const ConfigKey& key, const std::string& name) {
  return key.description.name == name ||
         std::find(key.other_spellings.begin(), key.other_spellings.end(), name) !=
             key.other_spellings.end();
}

std::string nearestOf(const std::vector<ConfigKey>& keys, const std::string& name) {
  std::vector<std::string> known;
  for (const ConfigKey& key : keys) {
    known.push_back(key.description.name);
    known.insert(known.end(), key.other_spellings.begin(), key.other_spellings.end());
  }
  return nearestKey(name, known);
}

/// The map in a file of its own. Its faults name that file.
void readMapFile(const YAML::Node& value, const ConfigKey& key, const std::string& path,
                 ParameterDraft& draft, ConfigFaults& faults) {
  const std::string file = resolvedPath(value.Scalar(), draft.base_directory);
  ConfigFaults file_faults(file);
  try {
    const YAML::Node map = yamlFromFile(file);
    if (map.IsMap()) {
      readMap(map, key.members, path + "/", draft, file_faults, key.is_foreign);
    } else {
      file_faults.add(map, "found " + foundText(map) + ", expected a map of " + path);
    }
  } catch (const ParameterError& error) {
    faults.add(value, path + ": " + error.what());
    draft.faulty.insert(path);
    return;
  }
  if (!file_faults.empty()) {
    draft.faulty.insert(path);
    faults.append(file_faults);
  }
}

void readEntry(const YAML::Node& value, const ConfigKey& key, const std::string& path,
               ParameterDraft& draft, ConfigFaults& faults) {
  std::string fault;
  if (key.members.empty()) {
    fault = key.read(value, draft);
  } else if (value.IsMap()) {
    readMap(value, key.members, path + "/", draft, faults, key.is_foreign);
  } else if (key.may_be_file && value.IsScalar() && !value.Scalar().empty()) {
    readMapFile(value, key, path, draft, faults);
  } else {
    fault = expected(value, key.may_be_file ? "a map or the path of a YAML file" : "a map");
  }
  if (!fault.empty()) {
    draft.faulty.insert(path);
    faults.add(value, path + ": " + fault);
  }
}

}  // namespace

std::string foundText(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return "'" + node.Scalar() + "'";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a map";
    case YAML::NodeType::Null:
    case YAML::NodeType::Undefined:
      break;
  }
  return "nothing";
}

ConfigKey numberKey(const KeyText& text, NumberRange range,
                    std::function<void(double, ParameterDraft&)> store) {
  ConfigKey key;
  key.description = {text.name, "number", text.unit, range.text(), text.default_value, text.doc};
  key.description.limits = range;
  const std::string what =
      "a number " + range.text() + (text.unit.empty() ? "" : " [" + text.unit + "]");
  key.read = [range, what, store = std::move(store)](const YAML::Node& node,
                                                     ParameterDraft& draft) -> std::string {
    const std::optional<double> value = asNumber(node);
    if (!value || !range.contains(*value)) {
      return expected(node, what);
    }
    store(*value, draft);
    return {};
  };
  return key;
}

ConfigKey numberKey(const ParameterRange& parameter, const std::string& default_value,
                    const std::string& doc, std::function<void(double, ParameterDraft&)> store) {
  return numberKey({parameter.name, parameter.unit, default_value, doc}, parameter.range,
                   std::move(store));
}

ConfigKey integerKey(const KeyText& text, NumberRange range,
                     std::function<void(std::int64_t, ParameterDraft&)> store) {
  ConfigKey key;
  key.description = {text.name, "integer", text.unit, range.text(), text.default_value, text.doc};
  key.description.limits = range;
  const std::string what =
      "an integer " + range.text() + (text.unit.empty() ? "" : " [" + text.unit + "]");
  key.read = [range, what, store = std::move(store)](const YAML::Node& node,
                                                     ParameterDraft& draft) -> std::string {
    // By way of double, so that 1e6 is as good as 1000000.
    const std::optional<double> value = asNumber(node);
    if (!value || !range.contains(*value) || *value != std::floor(*value)) {
      return expected(node, what);
    }
    store(static_cast<std::int64_t>(*value), draft);
    return {};
  };
  return key;
}

ConfigKey integerKey(const ParameterRange& parameter, const std::string& default_value,
                     const std::string& doc,
                     std::function<void(std::int64_t, ParameterDraft&)> store) {
  return integerKey({parameter.name, parameter.unit, default_value, doc}, parameter.range,
                    std::move(store));
}

std::string boolText(bool value) {
  return value ? "true" : "false";
}

ConfigKey boolKey(const KeyText& text, std::function<void(bool, ParameterDraft&)> store) {
  ConfigKey key;
  key.description = {text.name, "bool", text.unit, "true, false", text.default_value, text.doc};
  key.read = [store = std::move(store)](const YAML::Node& node,
                                        ParameterDraft& draft) -> std::string {
    bool value = false;
    if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) {
      return expected(node, "true or false");
    }
    store(value, draft);
    return {};
  };
  return key;
}

ConfigKey textKey(const KeyText& text,
                  std::function<void(const std::string&, ParameterDraft&)> store) {
  ConfigKey key;
  key.description = {text.name, "text", text.unit, "", text.default_value, text.doc};
  key.read = [store = std::move(store)](const YAML::Node& node,
                                        ParameterDraft& draft) -> std::string {
    if (!node.IsScalar()) {
      return expected(node, "a text");
    }
    store(node.Scalar(), draft);
    return {};
  };
  return key;
}

ConfigKey mapKey(const KeyText& text, std::vector<ConfigKey> members) {
  ConfigKey key;
  key.description = {text.name, "map", text.unit, "", text.default_value, text.doc};
  key.members = std::move(members);
  return key;
}

void readMap(const YAML::Node& map, const std::vector<ConfigKey>& keys, const std::string& prefix,
             ParameterDraft& draft, ConfigFaults& faults,
             const std::function<bool(const std::string&)>& is_foreign) {
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) {
      faults.add(entry.first, "a key is " + foundText(entry.first) + ", expected a name");
      continue;
    }
    const std::string& name = entry.first.Scalar();
    const auto key = std::find_if(keys.begin(), keys.end(), [&name](const ConfigKey& candidate) {
      return answersTo(candidate, name);
    });
    if (key == keys.end()) {
      const std::string nearest = nearestOf(keys, name);
      if (!is_foreign || !is_foreign(name) || editDistance(name, nearest) <= kMisspelling) {
        faults.add(entry.first,
                   prefix + name + ": unknown, the nearest known key is " + prefix + nearest);
      }
      continue;
    }
    const std::string path = prefix + key->description.name;
    if (!draft.given.insert(path).second) {
      draft.faulty.insert(path);
      faults.add(entry.first,
                 prefix + name + ": given twice" +
                     (key->other_spellings.empty() ? "" : " (spellings count as one)"));
      continue;
    }
    readEntry(entry.second, *key, path, draft, faults);
  }
}

}  // namespace fast_edi
