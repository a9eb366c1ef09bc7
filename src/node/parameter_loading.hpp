/// \file
/// From the parameter server to the map that parametersFromYaml() reads.
#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

namespace fast_edi {

/// The same value as YAML. Numbers keep their full precision.
/// \throws ParameterError for dates and binary data, which no parameter of ours is
YAML::Node yamlFromXmlRpc(const XmlRpc::XmlRpcValue& value);

/// Puts the folder `cfg` of this package before relative paths of files in \p map: the parameter
/// server does not say which file a path comes from.
void makePathsAbsolute(YAML::Node& map);

/// Everything in the private namespace of \p private_nh, as a map (empty when there is nothing),
/// without the keys that libraries of ours read there themselves (`image_transport`,
/// `diagnostic_period`). Paths in it are absolute.
/// \throws ParameterError
YAML::Node privateParameters(const ros::NodeHandle& private_nh);

}  // namespace fast_edi
