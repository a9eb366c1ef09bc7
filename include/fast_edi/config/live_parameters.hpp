/// \file
/// Parameters that can be changed while frames are deblurred: those that parameter_table.hpp calls
/// live. Ranges and messages are those of a configuration that is read at the start.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

class LiveParameters {
 public:
  /// By key, each as the text of a YAML scalar. A contrast threshold of "0" is one that comes from
  /// `biases`.
  using Values = std::map<std::string, std::string>;

  /// \param root what \p loaded was read from
  LiveParameters(LoadedParameters loaded, const YAML::Node& root);

  /// Applies each of \p wanted that can be used; the others keep their value.
  /// \return one line for each that was refused: key, what was found and what was expected
  std::vector<std::string> change(const Values& wanted);

  /// All live parameters.
  const Values& values() const { return values_; }
  const LoadedParameters& loaded() const { return loaded_; }

 private:
  std::string changeOne(const std::string& name, const std::string& text);
  std::string takeFromBiases(const std::string& threshold);

  LoadedParameters loaded_;
  Values values_;
};

/// A number as the text of a YAML scalar: no more digits than it needs to be read back the same.
std::string scalarText(double value);

}  // namespace fast_edi
