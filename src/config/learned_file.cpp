#include "fast_edi/config/learned_file.hpp"

#include <algorithm>
#include <array>

#include <yaml-cpp/yaml.h>

#include "config/config_file.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/config/parameter_error.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

/// More digits would say more than the learning knows.
constexpr int kThresholdDecimals = 4;
constexpr int kDelayDecimals = 0;

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

void LearnedFile::write(const ContrastThresholds& thresholds, std::int64_t event_delay_ns) {
  file_.write(learnedYaml(thresholds, event_delay_ns));
}

}  // namespace fast_edi
