/// \file
/// The parameters that a tuning starts from, changed one by one, and what it takes to get them
/// again: a YAML file, or words of a command line.
///
/// What is tuned stays: thresholds are those that are seen, and nothing is learned from the
/// recording (`refine_contrast` and `refine_delay` are false).
#pragma once

#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fast_edi/config/live_parameters.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

class TunedParameters {
 public:
  /// \param config YAML file, or empty: the overrides alone
  /// \param overrides `name:=value` in the order in which they apply, see applyOverrides()
  /// \param loaded what the two say for this recording
  /// \throws ParameterError when they cannot be read
  TunedParameters(const std::string& config, const std::vector<std::string>& overrides,
                  LoadedParameters loaded);

  /// Of a number that can be changed live.
  /// \throws std::invalid_argument for another parameter
  double value(const std::string& name) const;
  /// \return what was wrong with it, when it was refused and the old value stays; else empty
  std::string set(const std::string& name, double value);

  const LoadedParameters& loaded() const { return live_.loaded(); }

  /// All that differs from the defaults, as a configuration of its own.
  std::string yaml() const;
  /// All that differs from the file \p config, for a command line that names it.
  std::vector<std::string> overrides() const;

 private:
  const YAML::Node file_;  ///< as it was read
  const std::string base_directory_;
  YAML::Node given_;  ///< with the overrides
  LiveParameters live_;
};

}  // namespace fast_edi
