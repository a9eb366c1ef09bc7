#include "fast_edi/config/learned_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include <yaml-cpp/yaml.h>

#include "config/config_file.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/config/parameter_error.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

/// More digits would say more than the learning knows.
constexpr int kThresholdDecimals = 4;
constexpr int kDelayDecimals = 0;

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw std::runtime_error("cannot write " + path + ": " + reason);
}

void writeText(const std::string& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::trunc);
  file << text << std::flush;
  if (!file) {
    refuse(path, std::generic_category().message(errno));
  }
}

std::string line(const ParameterRange& parameter, double value, int decimals) {
  return std::string(parameter.name) + ": " + fixedText(value, decimals) + "\n";
}

}  // namespace

std::string learnedYaml(const ContrastThresholds& thresholds, std::int64_t event_delay_ns) {
  const double delay_us =
      static_cast<double>(event_delay_ns) / static_cast<double>(kNanosecondsPerMicrosecond);
  return line(limits::kContrastOn, thresholds.on, kThresholdDecimals) +
         line(limits::kContrastOff, thresholds.off, kThresholdDecimals) +
         line(limits::kEventDelay, delay_us, kDelayDecimals);
}

std::vector<std::string> learnedOverrides(const std::string& path) {
  const std::array<std::string, 3> names = {limits::kContrastOn.name, limits::kContrastOff.name,
                                            limits::kEventDelay.name};
  parametersFromFile(path);  // throws for values that are none
  std::vector<std::string> overrides;
  for (const auto& entry : yamlFromFile(path)) {
    const auto name = entry.first.as<std::string>();
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw ParameterError(path + ": " + name + " is not learned, expected " + names[0] + ", " +
                           names[1] + " and " + names[2] + " alone");
    }
    overrides.push_back(name + ":=" + entry.second.as<std::string>());
  }
  return overrides;
}

LearnedFile::LearnedFile(const std::string& path) : path_(path), active_path_(path + ".active") {
  writeText(active_path_, "");
}

LearnedFile::~LearnedFile() {
  std::error_code ignored;
  fs::remove(active_path_, ignored);
}

void LearnedFile::write(const ContrastThresholds& thresholds, std::int64_t event_delay_ns) {
  writeText(active_path_, learnedYaml(thresholds, event_delay_ns));
  std::error_code error;
  fs::rename(active_path_, path_, error);
  if (error) {
    refuse(path_, error.message());
  }
}

}  // namespace fast_edi
