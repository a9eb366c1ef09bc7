#include "config/config_file.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <ios>
#include <string>

#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

namespace {

/// Far more than any configuration needs; a device that never ends must not fill the memory.
constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMaxBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad() || (!file && !file.eof())) {
    throw ParameterError(path + ": cannot be read, expected a YAML file");
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMaxBytes) {
    throw ParameterError(path + ": larger than 1 MB, expected a YAML file of parameters");
  }
  return text;
}

}  // namespace

YAML::Node yamlFromFile(const std::string& path) {
  const std::string text = textOf(path);
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ParameterError(path + ":" + std::to_string(error.mark.line + 1) +
                         ": not YAML: " + error.msg);
  }
}

std::string resolvedPath(const std::string& path, const std::string& base_directory) {
  // An absolute path replaces what stands before it.
  return (std::filesystem::path(base_directory) / path).string();
}

}  // namespace fast_edi
