#include "fast_edi/config/dv_stream_parameters.hpp"

#include "config/config_faults.hpp"
#include "config/config_key.hpp"
#include "config/parameter_draft.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

constexpr NumberRange kPort{0.0, 65535.0};
constexpr NumberRange kStallTimeout_s{0.1, 3600.0};
constexpr NumberRange kMaxRetry_s{0.02, 60.0};

/// \param stream its name in keys
/// \param content the same for people
/// \param place where values go; must outlive the keys
void addPlace(const std::string& stream, const std::string& content, const DvStreamPlace& defaults,
              DvStreamPlace& place, std::vector<ConfigKey>& keys) {
  keys.push_back(integerKey({stream + "_port", "", numberText(defaults.port),
                             "TCP port of the " + content + "; 0: not received"},
                            kPort, [&place](std::int64_t value, ParameterDraft&) {
                              place.port = static_cast<int>(value);
                            }));
  keys.push_back(
      textKey({stream + "_socket", "", "\"\"",
               "path of the local (Unix) socket of the " + content + ", used instead of the port"},
              [&place](const std::string& value, ParameterDraft&) { place.socket = value; }));
}

/// \param read where values go; must outlive the keys
std::vector<ConfigKey> keysOf(DvStreamParameters& read) {
  const DvStreamParameters defaults;
  std::vector<ConfigKey> keys = {
      textKey({"address", "", defaults.address,
               "host on which DV runs, as a number or a name; of all ports"},
              [&read](const std::string& value, ParameterDraft&) { read.address = value; })};
  addPlace("events", "events", defaults.events, read.events, keys);
  addPlace("frames", "frames", defaults.frames, read.frames, keys);
  addPlace("imu", "IMU samples", defaults.imu, read.imu, keys);
  addPlace("triggers", "triggers", defaults.triggers, read.triggers, keys);
  keys.push_back(numberKey(
      {"stall_timeout_s", "s", numberText(defaults.stall_timeout_s),
       "silence after which a connection is given up and made anew. Triggers may be "
       "silent for longer"},
      kStallTimeout_s, [&read](double value, ParameterDraft&) { read.stall_timeout_s = value; }));
  keys.push_back(
      numberKey({"max_retry_s", "s", numberText(defaults.max_retry_s),
                 "longest time between two attempts to connect, which begin at 0.02 s and double"},
                kMaxRetry_s, [&read](double value, ParameterDraft&) { read.max_retry_s = value; }));
  keys.push_back(
      textKey({"frame_id", "", "\"\"", "`frame_id` of events and frames"},
              [&read](const std::string& value, ParameterDraft&) { read.frame_id = value; }));
  keys.push_back(textKey(
      {"camera_info_file", "", "\"\"",
       "absolute path of a calibration in the format of `camera_calibration`, published beside "
       "each frame"},
      [&read](const std::string& value, ParameterDraft&) { read.camera_info_file = value; }));
  return keys;
}

}  // namespace

DvStreamParameters dvStreamParametersFromYaml(const YAML::Node& root) {
  ConfigFaults faults;
  if (!root.IsMap() && !root.IsNull()) {
    faults.add(root, "the configuration is " + foundText(root) + ", expected a map");
    throw ParameterError(faults.text());
  }
  DvStreamParameters parameters;
  ParameterDraft draft;
  readMap(root, keysOf(parameters), "", draft, faults);
  if (faults.empty() && !parameters.events.isGiven() && !parameters.frames.isGiven() &&
      !parameters.imu.isGiven() && !parameters.triggers.isGiven()) {
    faults.add(root, "no stream has a port or a socket, expected at least one: events_port, ...");
  }
  if (!faults.empty()) {
    throw ParameterError(faults.text());
  }
  return parameters;
}

std::vector<ParameterDescription> dvStreamDescriptions() {
  DvStreamParameters unused;
  std::vector<ParameterDescription> descriptions;
  for (const ConfigKey& key : keysOf(unused)) {
    descriptions.push_back(key.description);
  }
  return descriptions;
}

}  // namespace fast_edi
