/// \file
/// The parameters of a running node: as set, with thresholds that follow the driver's biases.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <dynamic_reconfigure/Config.h>
#include <yaml-cpp/yaml.h>

#include "fast_edi/config/live_parameters.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

/// New thresholds are logged, and unusual ones are warned of.
class ParametersInForce {
 public:
  using Values = LiveParameters::Values;
  /// Hands new parameters to the pipeline.
  /// \throws std::exception and keeps the old ones when they cannot be used
  using Apply = std::function<void(const DeblurParameters&)>;

  /// What was refused of a request to change parameters.
  struct Refusals {
    std::vector<std::string> values;  ///< one line each; the others are in force
    std::string request;  ///< why none of the values is in force; empty if those not refused are
    std::string biases;   ///< why the driver's biases do not count any more; empty if they do
  };

  /// \param root private parameters of the node
  /// \param name of the node, which begins each line of the log
  /// \param bias_topic where the driver's biases come from
  /// \throws ParameterError when \p root cannot be used
  ParametersInForce(const YAML::Node& root, std::string name, std::string bias_topic, Apply apply);

  /// In force.
  const LoadedParameters& get() const { return in_force_; }
  /// Those that can be changed live, as set.
  const Values& values() const { return as_set_.values(); }

  /// Writes the thresholds and where they come from to the log.
  void logContrast() const;

  /// Changes parameters as far as \p wanted can be used. Biases of the driver that yield no
  /// threshold where they decide one now are dropped.
  Refusals change(const Values& wanted);
  /// Lets the thresholds follow the biases that the driver has in force, where these decide them.
  /// \return why not, with the old thresholds still in force; else empty
  std::string followBiases(const dynamic_reconfigure::ConfigConstPtr& biases);

 private:
  LoadedParameters withBiases(LoadedParameters parameters,
                              const dynamic_reconfigure::ConfigConstPtr& biases) const;
  void putInForce(LoadedParameters parameters);

  std::string name_;
  std::string bias_topic_;
  Apply apply_;
  LoadedParameters in_force_;
  LiveParameters as_set_;
  dynamic_reconfigure::ConfigConstPtr driver_biases_;  ///< the last that could be used
};

}  // namespace fast_edi
