/// \file
/// User-facing parameters: one parser for the YAML files of `cfg/`, for `deblur_bag --config` and,
/// converted by parameter_loading, for the nodelet's private namespace.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fast_edi/core/parameters.hpp"

namespace fast_edi {

/// A configuration that cannot be used. what() names the key, what was found and what was expected,
/// one line for each fault.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Keys that only the ROS layer uses; the core has no notion of them.
struct RosParameters {
  std::string frame_id;   ///< overrides an empty frame_id
  bool lazy = true;       ///< subscribe to inputs only while an image output is subscribed to
  int latent_images = 0;  ///< images per exposure on latent/image_raw; 0 = off
};

struct LoadedParameters {
  DeblurParameters deblur;
  RosParameters ros;
  std::vector<std::string> warnings;  ///< e.g. an unusual threshold; worth telling, not fatal
  std::string contrast_origin;        ///< "contrast_threshold_on/off" or "biases": what is in force
};

/// Reads all parameters. Missing keys take their defaults, except that thresholds need either
/// `contrast_threshold_on`/`_off` or `biases`.
/// \param root a map
/// \param base_directory relative `response_file` paths start here
/// \throws ParameterError for unknown or misspelt keys (naming the nearest known key), wrong types
///         and values out of range
LoadedParameters parametersFromYaml(const YAML::Node& root, const std::string& base_directory);

/// \throws ParameterError also when the file cannot be read or parsed (naming file and line)
LoadedParameters parametersFromFile(const std::string& path);

/// Applies `key:=value` overrides on top of a parsed map, e.g. {"contrast_threshold_on:=0.36"}.
/// \throws ParameterError for an argument without ":="
void applyOverrides(YAML::Node& root, const std::vector<std::string>& overrides);

/// All known top-level keys in the order of README's table.
const std::vector<std::string>& parameterKeys();

}  // namespace fast_edi
