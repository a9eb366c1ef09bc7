#include "python/parameter_dict.hpp"

#include <filesystem>

#include <pybind11/pybind11.h>
#include <yaml-cpp/yaml.h>

#include "config/config_file.hpp"

namespace fast_edi::python {
namespace {

namespace py = pybind11;

YAML::Node toYaml(const std::string& key, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) {
    return YAML::Node(value.cast<bool>());
  }
  if (py::isinstance<py::str>(value)) {
    return YAML::Node(value.cast<std::string>());
  }
  if (py::isinstance<py::dict>(value)) {
    YAML::Node map(YAML::NodeType::Map);
    for (const auto& [inner_key, inner] : py::reinterpret_borrow<py::dict>(value)) {
      const auto name = std::string(py::str(inner_key));
      map[name] = toYaml(key + "/" + name, inner);
    }
    return map;
  }
  // Also numpy's. What Python prints of a number is read back as the same number.
  if (PyIndex_Check(value.ptr()) != 0) {
    return YAML::Node(
        std::string(py::str(py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr())))));
  }
  if (PyFloat_Check(value.ptr()) != 0 || PyNumber_Check(value.ptr()) != 0) {
    return YAML::Node(std::string(py::str(py::float_(py::reinterpret_borrow<py::object>(value)))));
  }
  throw py::type_error(key + " is of type " + std::string(py::str(py::type::handle_of(value))) +
                       ", expected bool, int, float, str or a dict of these");
}

}  // namespace

LoadedParameters loadParameters(const std::string& config, const py::dict& parameters) {
  YAML::Node root = config.empty() ? YAML::Node(YAML::NodeType::Map) : yamlFromFile(config);
  for (const auto& [key, value] : parameters) {
    const auto name = std::string(py::str(key));
    if (!root.IsMap() && !root.IsNull()) {
      break;  // refused below
    }
    root[name] = toYaml(name, value);
  }
  const std::string folder = std::filesystem::path(config).parent_path().string();
  try {
    return parametersFromYaml(root, folder);
  } catch (const ParameterError& error) {
    throw ParameterError(config.empty() ? error.what() : config + ": " + error.what());
  }
}

ContrastThresholds contrastFromBiases(const std::string& path) {
  YAML::Node root = yamlFromFile(path);
  // A file of the driver's has the biases at its top level, a configuration has them in a map.
  if (root.IsMap() && root["DiffBn_coarse"].IsDefined()) {
    root = YAML::Node(YAML::NodeType::Map);
    root["biases"] = path;
    return parametersFromYaml(root, ".").deblur.thresholds;
  }
  return parametersFromFile(path).deblur.thresholds;
}

}  // namespace fast_edi::python
