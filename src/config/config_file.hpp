/// \file
/// Files that a configuration lies in or names.
#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

namespace fast_edi {

/// \throws ParameterError naming the file, and the line that is not YAML
YAML::Node yamlFromFile(const std::string& path);

/// \param path as a configuration has it; a relative one starts at \p base_directory
std::string resolvedPath(const std::string& path, const std::string& base_directory);

}  // namespace fast_edi
