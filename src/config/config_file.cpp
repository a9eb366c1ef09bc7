#include "config_file.hpp"

#include <filesystem>

#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

YAML::Node yamlFromFile(const std::string& path) {
  try {
    return YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw ParameterError(path + ": cannot be read, expected a YAML file");
  } catch (const YAML::ParserException& error) {
    throw ParameterError(path + ":" + std::to_string(error.mark.line + 1) +
                         ": not YAML: " + error.msg);
  }
}

std::string resolvedPath(const std::string& path, const std::string& base_directory) {
  // An absolute path replaces what stands before it.
  return (std::filesystem::path(base_directory) / path).string();
}

}  // namespace fast_edi
