/// \file
/// What there is to configure, for people: the tables in the documents and the tools' help are made
/// from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {

/// One key of a configuration.
struct ParameterDescription {
  std::string name;
  std::string type;           ///< "number", "integer", "bool", "text", "map" or "choice"
  std::string unit;           ///< empty when it has none
  std::string range;          ///< what is accepted; empty when anything of the type is
  std::string default_value;  ///< taken from the code's own defaults
  std::string doc;
  std::optional<NumberRange> limits = {};  ///< of numbers and integers
  /// Can be changed while frames are deblurred; else a new value takes a new start.
  bool live = false;
};

/// All keys at the top level, in the order of cfg/README.md.
std::vector<ParameterDescription> parameterDescriptions();

/// All keys of the map `biases`.
std::vector<ParameterDescription> biasDescriptions();

/// A Markdown table, one line for each key.
std::string markdownTable(const std::vector<ParameterDescription>& descriptions);

}  // namespace fast_edi
