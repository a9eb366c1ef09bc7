/// \file
/// Parameters as Python gives them: a YAML file, and keys with values of Python's types.
#pragma once

#include <string>

#include <pybind11/pytypes.h>

#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi::python {

/// \param config path of a YAML file; empty for none
/// \param parameters by key, replacing those of the file: bool, int, float, str, or a dict of these
/// \throws ParameterError as parametersFromYaml()
/// \throws pybind11::type_error for a value of another type, naming its key
LoadedParameters loadParameters(const std::string& config, const pybind11::dict& parameters);

/// Thresholds of a configuration, or of a driver's own file of biases.
/// \throws ParameterError as parametersFromYaml()
ContrastThresholds contrastFromBiases(const std::string& path);

}  // namespace fast_edi::python
