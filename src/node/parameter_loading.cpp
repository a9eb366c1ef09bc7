#include "node/parameter_loading.hpp"

#include <filesystem>
#include <string>

#include <ros/package.h>
#include <ros/param.h>

#include "fast_edi/config/live_parameters.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

YAML::Node convert(XmlRpc::XmlRpcValue value, const std::string& name) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(std::to_string(static_cast<int>(value)));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(scalarText(static_cast<double>(value)));
    case XmlRpc::XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) {
        list.push_back(convert(value[i], name + "[" + std::to_string(i) + "]"));
      }
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& member : value) {
        map[member.first] = convert(member.second, name + "/" + member.first);
      }
      return map;
    }
    case XmlRpc::XmlRpcValue::TypeInvalid:
    case XmlRpc::XmlRpcValue::TypeDateTime:
    case XmlRpc::XmlRpcValue::TypeBase64:
      break;
  }
  throw ParameterError(name +
                       ": found a date or binary data, expected a number, text, list or map");
}

}  // namespace

YAML::Node yamlFromXmlRpc(const XmlRpc::XmlRpcValue& value) {
  return convert(value, "parameters");
}

void makePathsAbsolute(YAML::Node& map) {
  for (const char* key : {"response_file", "biases"}) {
    const YAML::Node value = map[key];
    if (value.IsDefined() && value.IsScalar() && !value.Scalar().empty() &&
        std::filesystem::path(value.Scalar()).is_relative()) {
      map[key] = ros::package::getPath("fast_edi") + "/cfg/" + value.Scalar();
    }
  }
}

YAML::Node privateParameters(const ros::NodeHandle& private_nh) {
  XmlRpc::XmlRpcValue value;
  if (!ros::param::get(private_nh.getNamespace(), value) ||
      value.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    return YAML::Node(YAML::NodeType::Map);
  }
  YAML::Node map = yamlFromXmlRpc(value);
  for (const char* foreign : {"image_transport", "diagnostic_period"}) {
    map.remove(foreign);
  }
  makePathsAbsolute(map);
  return map;
}

}  // namespace fast_edi
