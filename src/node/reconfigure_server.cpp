#include "node/reconfigure_server.hpp"

#include <string>
#include <utility>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/server.h>
#include <ros/master.h>
#include <boost/thread/recursive_mutex.hpp>

#include "fast_edi/DeblurConfig.h"
#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

using Values = LiveParameters::Values;

Values valuesOf(const DeblurConfig& config) {
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  Values values;
  for (const auto& entry : message.bools) {
    values[entry.name] = entry.value != 0 ? "true" : "false";
  }
  for (const auto& entry : message.ints) {
    values[entry.name] = std::to_string(entry.value);
  }
  for (const auto& entry : message.doubles) {
    values[entry.name] = scalarText(entry.value);
  }
  for (const auto& entry : message.strs) {
    values[entry.name] = entry.value;
  }
  return values;
}

void assign(const Values& values, DeblurConfig& config) {
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  const auto number = [&values](const std::string& name) {
    return parseNumber(values.at(name)).value();
  };
  for (auto& entry : message.bools) {
    entry.value = static_cast<std::uint8_t>(YAML::Node(values.at(entry.name)).as<bool>());
  }
  for (auto& entry : message.ints) {
    entry.value = static_cast<int>(number(entry.name));
  }
  for (auto& entry : message.doubles) {
    entry.value = number(entry.name);
  }
  for (auto& entry : message.strs) {
    entry.value = values.at(entry.name);
  }
  config.__fromMessage__(message);
}

/// The generated class without what the library's server would do by itself. (The names are the
/// library's.)
class ServedConfig : public DeblurConfig {
 public:
  ServedConfig() = default;
  ServedConfig(const DeblurConfig& config) : DeblurConfig(config) {}  // NOLINT: not explicit

  /// What is out of range is refused by the handler.
  void __clamp__() {}
  /// Parameters are read by the node itself, and only once.
  void __fromServer__(const ros::NodeHandle& /*nh*/) {}
  /// Impl writes what has changed: each value takes a call to the master.
  void __toServer__(const ros::NodeHandle& /*nh*/) const {}
};

}  // namespace

class ReconfigureServer::Impl {
 public:
  Impl(const ros::NodeHandle& private_nh, const Values& in_force, Handler handler)
      : nh_(private_nh), handler_(std::move(handler)), server_(mutex_, private_nh) {
    server_.setCallback([this, in_force](ServedConfig& config, std::uint32_t /*level*/) {
      if (last_.empty()) {
        store(in_force, config);
      } else {
        change(config);
      }
    });
  }

 private:
  void change(ServedConfig& config) {
    Values wanted;
    for (const auto& [name, value] : valuesOf(config)) {
      if (value != last_.at(name)) {
        wanted.emplace(name, value);
      }
    }
    if (!wanted.empty()) {
      store(handler_(wanted), config);
    }
  }

  /// Makes \p config what is in force, and the parameter server's values too.
  void store(const Values& in_force, DeblurConfig& config) {
    assign(in_force, config);
    const Values before = std::exchange(last_, valuesOf(config));
    if (!ros::master::check()) {
      return;  // with it the parameter server is gone, and each value would wait for both
    }
    for (const auto& parameter : DeblurConfig::__getParamDescriptions__()) {
      const std::string& name = parameter->name;
      const auto old = before.find(name);
      if (old != before.end() && old->second == last_.at(name)) {
        continue;
      }
      if (isFromBiases(name)) {
        nh_.deleteParam(name);
      } else {
        parameter->toServer(nh_, config);
      }
    }
  }

  bool isFromBiases(const std::string& name) const {
    return (name == "contrast_threshold_on" || name == "contrast_threshold_off") &&
           last_.at(name) == "0";
  }

  ros::NodeHandle nh_;
  Handler handler_;
  boost::recursive_mutex mutex_;
  Values last_;  ///< in force, as the server writes them
  dynamic_reconfigure::Server<ServedConfig> server_;
};

ReconfigureServer::ReconfigureServer(const ros::NodeHandle& private_nh, const Values& in_force,
                                     Handler handler)
    : impl_(std::make_unique<Impl>(private_nh, in_force, std::move(handler))) {}

ReconfigureServer::~ReconfigureServer() = default;

}  // namespace fast_edi
