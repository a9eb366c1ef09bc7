#include "fast_edi/config/live_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "config/contrast_keys.hpp"
#include "config/parameter_draft.hpp"
#include "config/parameter_keys.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/calibration/contrast_from_bias.hpp"

namespace fast_edi {
namespace {

/// A contrast threshold that comes from biases.
constexpr const char* kFromBiases = "0";

bool isThreshold(const std::string& name) {
  return name == kContrastOn || name == kContrastOff;
}

bool isZero(const std::string& text) {
  return parseNumber(text) == 0.0;
}

std::string startValue(const ParameterDescription& key, const YAML::Node& root) {
  if (root.IsMap() && root[key.name].IsDefined()) {
    return root[key.name].Scalar();
  }
  return isThreshold(key.name) ? kFromBiases : key.default_value;
}

}  // namespace

std::string scalarText(double value) {
  if (std::isnan(value)) {
    return ".nan";
  }
  if (std::isinf(value)) {
    return value > 0.0 ? ".inf" : "-.inf";
  }
  return exactText(value);
}

LiveParameters::LiveParameters(LoadedParameters loaded, const YAML::Node& root)
    : loaded_(std::move(loaded)) {
  for (const ConfigKey& key : topLevelKeys()) {
    if (key.description.live) {
      values_[key.description.name] = startValue(key.description, root);
    }
  }
}

std::vector<std::string> LiveParameters::change(const Values& wanted) {
  std::vector<std::string> refusals;
  for (const auto& [name, text] : wanted) {
    const std::string fault = changeOne(name, text);
    if (fault.empty()) {
      values_[name] = text;
    } else {
      refusals.push_back(name + ": " + fault);
    }
  }
  loaded_.warnings = contrastWarnings(loaded_.deblur.thresholds);
  return refusals;
}

/// \return what was found and expected when the value cannot be used
std::string LiveParameters::changeOne(const std::string& name, const std::string& text) {
  const std::vector<ConfigKey>& keys = topLevelKeys();
  const auto key = std::find_if(keys.begin(), keys.end(), [&name](const ConfigKey& candidate) {
    return candidate.description.name == name && candidate.description.live;
  });
  if (key == keys.end()) {
    return "found '" + text + "', expected a parameter that can be changed without a new start";
  }
  const YAML::Node value(text);
  if (isThreshold(name) && isZero(text)) {
    return takeFromBiases(name);
  }
  ParameterDraft draft;
  draft.loaded = loaded_;
  std::string fault = key->read(value, draft);
  if (!fault.empty()) {
    return isThreshold(name) ? fault + ", or 0 for the one from biases" : fault;
  }
  try {
    validate(draft.loaded.deblur);
  } catch (const std::invalid_argument& error) {
    return "found '" + text + "': " + error.what();
  }
  loaded_ = std::move(draft.loaded);
  if (isThreshold(name)) {
    (name == kContrastOn ? loaded_.from_biases.on : loaded_.from_biases.off) = false;
    loaded_.contrast_origin = contrastOrigin(loaded_.from_biases);
  }
  return {};
}

std::string LiveParameters::takeFromBiases(const std::string& threshold) {
  const bool on = threshold == kContrastOn;
  const std::string found = "found '0', which means from biases; ";
  if (!loaded_.biases) {
    return found + "expected a number > 0, since the configuration has no biases";
  }
  NeededThresholds needed = {on, !on};
  try {
    const ContrastThresholds derived = contrastFromBias(*loaded_.biases, needed);
    ContrastThresholds& thresholds = loaded_.deblur.thresholds;
    (on ? thresholds.on : thresholds.off) = on ? derived.on : derived.off;
  } catch (const std::invalid_argument& error) {
    return found + error.what();
  }
  (on ? loaded_.from_biases.on : loaded_.from_biases.off) = true;
  loaded_.contrast_origin = contrastOrigin(loaded_.from_biases);
  return {};
}

}  // namespace fast_edi
