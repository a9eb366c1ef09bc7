/// \file
/// User-facing parameters: one parser for the YAML files of `cfg/`, for `deblur_bag --config` and,
/// converted by parameter_loading, for the nodelet's private namespace. The keys are described in
/// parameter_table.hpp.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fast_edi/calibration/contrast_from_bias.hpp"
#include "fast_edi/config/parameter_error.hpp"
#include "fast_edi/parameters/parameters.hpp"

namespace fast_edi {

/// Keys that only the ROS layer uses; the core has no notion of them.
struct RosParameters {
  std::string frame_id;      ///< overrides an empty frame_id
  bool lazy = true;          ///< subscribe to inputs only while an image output is subscribed to
  std::string learned_file;  ///< see learnedFilePath()
};

struct LoadedParameters {
  DeblurParameters deblur;
  RosParameters ros;
  std::vector<std::string> warnings;  ///< e.g. an unusual threshold; worth a message, not fatal
  /// What the thresholds in force come from: "contrast_threshold_on, contrast_threshold_off",
  /// "biases", or "biases, contrast_threshold_off" (or _on) when one of them is given explicitly.
  std::string contrast_origin;
  /// Present when all biases of at least one threshold are given, in force or not.
  std::optional<BiasConfiguration> biases;
  /// Which thresholds the biases decide.
  NeededThresholds from_biases = {false, false};
};

/// Reads all parameters. Missing keys take their defaults, except that thresholds need either
/// `contrast_threshold_on`/`_off` or `biases`; an explicit threshold wins.
/// \param root a map, or null for an empty one
/// \param base_directory relative paths of `response_file` and `biases` start here
/// \throws ParameterError for unknown, misspelt or repeated keys (naming the nearest known key),
///         wrong types and values out of range
LoadedParameters parametersFromYaml(const YAML::Node& root, const std::string& base_directory);

/// Relative paths of `response_file` and `biases` start at the folder of the file.
/// \param overrides see applyOverrides()
/// \throws ParameterError also when the file cannot be read or parsed (naming file and line)
LoadedParameters parametersFromFile(const std::string& path,
                                    const std::vector<std::string>& overrides = {});

/// Applies `key:=value` overrides on top of a parsed map, e.g. {"contrast_threshold_on:=0.36"}; a
/// key within a map is written with a slash, e.g. {"biases/DiffBn_fine:=39"}.
/// \throws ParameterError for an argument without ":=" or whose value is not YAML
void applyOverrides(YAML::Node& root, const std::vector<std::string>& overrides);

/// All known top-level keys in the order of cfg/README.md.
const std::vector<std::string>& parameterKeys();

}  // namespace fast_edi
