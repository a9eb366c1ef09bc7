#include "fast_edi/config/parameters_from_yaml.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "config/config_faults.hpp"
#include "config/config_file.hpp"
#include "config/contrast_keys.hpp"
#include "config/parameter_draft.hpp"
#include "config/parameter_keys.hpp"

namespace fast_edi {
namespace {

/// Those of the four numbers behind one threshold that the configuration lacks.
std::string missingBiases(const ParameterDraft& draft, const std::string& name) {
  std::string missing;
  for (const std::string& bias : {std::string("DiffBn"), name}) {
    for (const char* part : {"_coarse", "_fine"}) {
      if (!draft.has(kBiases + ("/" + bias + part))) {
        missing += (missing.empty() ? "" : ", ") + bias + part;
      }
    }
  }
  return missing;
}

/// Whether a threshold that is not given can come from the biases; if not, that is a fault.
bool neededFromBiases(const std::string& key, const std::string& bias, const YAML::Node& root,
                      const ParameterDraft& draft, ConfigFaults& faults) {
  if (draft.has(key)) {
    return false;
  }
  if (!draft.has(kBiases)) {
    faults.add(root, key + ": not given, nor biases it could be computed from; expected " +
                         kContrastOn + " and " + kContrastOff +
                         ", or biases (see the files in cfg/)");
    return false;
  }
  const std::string missing = missingBiases(draft, bias);
  if (!missing.empty() && !draft.isFaulty(kBiases)) {
    faults.add(root[kBiases],
               "biases: " + missing + " missing, expected because " + key + " is not given");
  }
  return missing.empty();
}

/// Whether any value below `biases` could not be read; what follows from them is then anyone's
/// guess.
bool biasesAreFaulty(const ParameterDraft& draft) {
  return std::any_of(draft.faulty.begin(), draft.faulty.end(), [](const std::string& key) {
    return key.compare(0, std::strlen(kBiases), kBiases) == 0;
  });
}

void decideThresholds(const YAML::Node& root, ParameterDraft& draft, ConfigFaults& faults) {
  LoadedParameters& loaded = draft.loaded;
  loaded.from_biases.on = neededFromBiases(kContrastOn, "OnBn", root, draft, faults);
  loaded.from_biases.off = neededFromBiases(kContrastOff, "OffBn", root, draft, faults);
  loaded.contrast_origin = contrastOrigin(loaded.from_biases);
  if (!draft.has(kBiases) || biasesAreFaulty(draft)) {
    return;
  }
  if (missingBiases(draft, "OnBn").empty() || missingBiases(draft, "OffBn").empty()) {
    loaded.biases = draft.biases;
  }
  if (!loaded.from_biases.on && !loaded.from_biases.off) {
    return;
  }
  try {
    const ContrastThresholds derived = contrastFromBias(draft.biases, loaded.from_biases);
    ContrastThresholds& thresholds = loaded.deblur.thresholds;
    thresholds.on = loaded.from_biases.on ? derived.on : thresholds.on;
    thresholds.off = loaded.from_biases.off ? derived.off : thresholds.off;
  } catch (const std::invalid_argument& error) {
    faults.add(root[kBiases], std::string("biases: ") + error.what());
  }
}

void loadResponse(const YAML::Node& root, ParameterDraft& draft, ConfigFaults& faults) {
  if (draft.response_file.empty()) {
    draft.loaded.deblur.response = CameraResponse::linear(draft.response_offset_dn);
    return;
  }
  if (draft.response_offset_dn != 0.0) {
    faults.add(root["response_offset_dn"],
               "response_offset_dn: belongs to the linear response, expected 0 beside "
               "response_file");
  }
  try {
    draft.loaded.deblur.response =
        CameraResponse::fromFile(resolvedPath(draft.response_file, draft.base_directory));
  } catch (const std::runtime_error& error) {
    faults.add(root["response_file"], std::string("response_file: ") + error.what());
  }
}

/// \param file named in messages; may be empty
LoadedParameters load(const YAML::Node& root, const std::string& base_directory,
                      const std::string& file) {
  ConfigFaults faults(file);
  if (!root.IsMap() && !root.IsNull()) {
    faults.add(root, "the configuration is " + foundText(root) + ", expected a map");
    throw ParameterError(faults.text());
  }
  ParameterDraft draft;
  draft.base_directory = base_directory;
  readMap(root, topLevelKeys(), "", draft, faults);
  decideThresholds(root, draft, faults);
  loadResponse(root, draft, faults);
  if (!faults.empty()) {
    throw ParameterError(faults.text());
  }
  try {
    validate(draft.loaded.deblur);
  } catch (const std::invalid_argument& error) {
    faults.add(root, error.what());
    throw ParameterError(faults.text());
  }
  draft.loaded.warnings = contrastWarnings(draft.loaded.deblur.thresholds);
  return draft.loaded;
}

}  // namespace

LoadedParameters parametersFromYaml(const YAML::Node& root, const std::string& base_directory) {
  return load(root, base_directory, "");
}

LoadedParameters parametersFromFile(const std::string& path,
                                    const std::vector<std::string>& overrides) {
  YAML::Node root = yamlFromFile(path);
  applyOverrides(root, overrides);
  return load(root, std::filesystem::path(path).parent_path().string(), path);
}

void applyOverrides(YAML::Node& root, const std::vector<std::string>& overrides) {
  if (!overrides.empty() && !root.IsMap() && !root.IsNull()) {
    throw ParameterError("the configuration is " + foundText(root) + ", expected a map");
  }
  const std::string separator = ":=";
  for (const std::string& argument : overrides) {
    const std::size_t split = argument.find(separator);
    if (split == std::string::npos || split == 0) {
      throw ParameterError("'" + argument + "': expected key:=value");
    }
    const std::string key = argument.substr(0, split);
    const std::string text = argument.substr(split + separator.size());
    YAML::Node value;
    try {
      value = YAML::Load(text);
      if (!value.IsMap() && !value.IsSequence()) {
        // A node that knows of no line, since it stands in none.
        value = YAML::Node(value.IsScalar() ? value.Scalar() : text);
      }
    } catch (const YAML::Exception& error) {
      throw ParameterError("'" + argument + "': the value is not YAML: " + error.msg);
    }
    const std::size_t slash = key.find('/');
    if (slash == std::string::npos) {
      root[key] = value;
      continue;
    }
    YAML::Node map = root[key.substr(0, slash)];
    if (map.IsDefined() && !map.IsMap()) {
      throw ParameterError("'" + argument + "': " + key.substr(0, slash) + " is " + foundText(map) +
                           ", expected a map");
    }
    map[key.substr(slash + 1)] = value;
  }
}

const std::vector<std::string>& parameterKeys() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const ConfigKey& key : topLevelKeys()) {
      result.push_back(key.description.name);
    }
    return result;
  }();
  return names;
}

}  // namespace fast_edi
