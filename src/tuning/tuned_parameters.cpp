#include "tuning/tuned_parameters.hpp"

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/config_file.hpp"
#include "config/contrast_keys.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/config/parameter_table.hpp"

namespace fast_edi {
namespace {

/// Biases give thresholds to some 10 %.
constexpr int kThresholdDecimals = 4;
constexpr const char* kResponseFile = "response_file";

YAML::Node fileOf(const std::string& config) {
  return config.empty() ? YAML::Node(YAML::NodeType::Map) : yamlFromFile(config);
}

YAML::Node withOverrides(const YAML::Node& file, const std::vector<std::string>& overrides) {
  YAML::Node root = YAML::Clone(file);
  applyOverrides(root, overrides);
  return root;
}

bool isThreshold(const std::string& name) {
  return name == kContrastOn || name == kContrastOff;
}

/// An empty text is that of no file and no name.
bool isDefault(const YAML::Node& value, const ParameterDescription& parameter) {
  return value.IsScalar() && (value.Scalar().empty() || value.Scalar() == parameter.default_value);
}

bool isIn(const YAML::Node& map, const std::string& name) {
  return map.IsMap() && map[name].IsDefined();
}

}  // namespace

TunedParameters::TunedParameters(const std::string& config,
                                 const std::vector<std::string>& overrides, LoadedParameters loaded)
    : file_(fileOf(config)),
      base_directory_(std::filesystem::path(config).parent_path().string()),
      given_(withOverrides(file_, overrides)),
      live_(std::move(loaded), given_) {
  const NeededThresholds from_biases = live_.loaded().from_biases;
  const ContrastThresholds thresholds = live_.loaded().deblur.thresholds;
  LiveParameters::Values values = {{"refine_contrast", "false"}, {"refine_delay", "false"}};
  if (from_biases.on) {
    values[kContrastOn] = fixedText(thresholds.on, kThresholdDecimals);
  }
  if (from_biases.off) {
    values[kContrastOff] = fixedText(thresholds.off, kThresholdDecimals);
  }
  live_.change(values);
}

double TunedParameters::value(const std::string& name) const {
  const auto found = live_.values().find(name);
  const std::optional<double> number =
      found == live_.values().end() ? std::nullopt : parseNumber(found->second);
  if (!number) {
    throw std::invalid_argument(name + ": expected a number that can be changed live");
  }
  return *number;
}

std::string TunedParameters::set(const std::string& name, double value) {
  const std::vector<std::string> refusals = live_.change({{name, scalarText(value)}});
  return refusals.empty() ? std::string() : refusals.front();
}

std::string TunedParameters::yaml() const {
  YAML::Emitter out;
  out << YAML::BeginMap;
  for (const ParameterDescription& parameter : parameterDescriptions()) {
    const std::string& name = parameter.name;
    if (parameter.live) {
      const std::string& text = live_.values().at(name);
      if (isThreshold(name) || text != parameter.default_value) {
        out << YAML::Key << name << YAML::Value << text;
      }
    } else if (name != kBiases && isIn(given_, name) &&  // the thresholds are there instead
               !isDefault(given_[name], parameter)) {
      out << YAML::Key << name << YAML::Value;
      if (name == kResponseFile) {
        const std::string path = resolvedPath(given_[name].Scalar(), base_directory_);
        out << std::filesystem::absolute(path).string();
      } else {
        out << given_[name];
      }
    }
  }
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

std::vector<std::string> TunedParameters::overrides() const {
  std::vector<std::string> words;
  for (const ParameterDescription& parameter : parameterDescriptions()) {
    const std::string& name = parameter.name;
    const bool in_file = isIn(file_, name);
    if (parameter.live) {
      const std::string& text = live_.values().at(name);
      const std::string before = in_file             ? file_[name].Scalar()
                                 : isThreshold(name) ? std::string()
                                                     : parameter.default_value;
      if (text != before) {
        words.push_back(name + ":=" + text);
      }
    } else if (name != kBiases && isIn(given_, name)) {
      const std::string text = YAML::Dump(given_[name]);
      if (!in_file || text != YAML::Dump(file_[name])) {
        words.push_back(name + ":=" + text);
      }
    }
  }
  return words;
}

}  // namespace fast_edi
