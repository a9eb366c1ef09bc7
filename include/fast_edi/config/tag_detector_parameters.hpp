/// \file
/// User-facing parameters of the tag detector's node and nodelet.
#pragma once

#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fast_edi/config/parameter_table.hpp"
#include "fast_edi/tags/tag_detector.hpp"

namespace fast_edi {

struct TagDetectorParameters {
  TagDetectorSettings detector;
  double tag_size_m = 0.16;  ///< side of the tag's outline, see TagDetection::corners
  bool rectified = false;    ///< images are rectified: camera_info's P holds, not its K and D
  std::string frame_id;      ///< overrides an empty frame_id
  bool lazy = true;          ///< subscribe to the images only while an output is subscribed to
};

/// Missing keys take their defaults.
/// \param root a map, or null for an empty one
/// \throws ParameterError for unknown, misspelt or repeated keys (naming the nearest known key),
///         wrong types and values out of range
TagDetectorParameters tagDetectorParametersFromYaml(const YAML::Node& root);

/// All keys in the order of launch/apriltags.md.
std::vector<ParameterDescription> tagDetectorDescriptions();

}  // namespace fast_edi
