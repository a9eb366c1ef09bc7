/// \file
/// User-facing parameters of the node and nodelet that receive DV's streams.
#pragma once

#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fast_edi/config/parameter_table.hpp"

namespace fast_edi {

/// Where one stream is served.
struct DvStreamPlace {
  int port = 0;        ///< TCP; 0: not received, unless there is a socket
  std::string socket;  ///< path of a local socket, which comes before the port

  bool isGiven() const { return port != 0 || !socket.empty(); }
};

struct DvStreamParameters {
  std::string address = "127.0.0.1";
  DvStreamPlace events{7777, {}};
  DvStreamPlace frames{7778, {}};
  DvStreamPlace imu;
  DvStreamPlace triggers;
  double stall_timeout_s = 2.0;
  double max_retry_s = 0.5;
  std::string frame_id;          ///< of events and frames
  std::string camera_info_file;  ///< empty: no calibration is published
};

/// Missing keys take their defaults.
/// \param root a map, or null for an empty one
/// \throws ParameterError for unknown, misspelt or repeated keys (naming the nearest known key),
///         wrong types and values out of range, and when nothing is to be received
DvStreamParameters dvStreamParametersFromYaml(const YAML::Node& root);

/// All keys in the order of launch/dv_stream.md.
std::vector<ParameterDescription> dvStreamDescriptions();

}  // namespace fast_edi
