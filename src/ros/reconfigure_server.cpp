#include "fast_edi/ros/reconfigure_server.hpp"

#include <optional>
#include <string>
#include <utility>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/server.h>
#include <boost/thread/recursive_mutex.hpp>

#include "fast_edi/DeblurConfig.h"

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
    return YAML::Node(values.at(name)).as<double>();
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

/// The generated class, but for three things that the library's server does with it. (The names
/// are the library's.)
class ServedConfig : public DeblurConfig {
 public:
  ServedConfig() = default;
  ServedConfig(const DeblurConfig& config) : DeblurConfig(config) {}  // NOLINT: not explicit

  /// Nothing: what is out of range is refused by the handler.
  void __clamp__() {}
  /// Nothing: parameters are read by the node itself, and only once.
  void __fromServer__(const ros::NodeHandle& /*nh*/) {}
  void __toServer__(const ros::NodeHandle& nh) const {
    if (!in_force) {
      return;  // the library's defaults, before it was told what is in force
    }
    DeblurConfig::__toServer__(nh);
    if (contrast_threshold_on == 0.0) {
      nh.deleteParam("contrast_threshold_on");
    }
    if (contrast_threshold_off == 0.0) {
      nh.deleteParam("contrast_threshold_off");
    }
  }

  bool in_force = false;
};

}  // namespace

class ReconfigureServer::Impl {
 public:
  Impl(const ros::NodeHandle& private_nh, const Values& in_force, Handler handler)
      : handler_(std::move(handler)) {
    // Requests that come meanwhile wait until the server knows what is in force.
    const boost::recursive_mutex::scoped_lock lock(mutex_);
    server_.emplace(mutex_, private_nh);
    server_->setCallback([this, in_force](ServedConfig& config, std::uint32_t /*level*/) {
      if (last_.empty()) {
        assign(in_force, config);
        config.in_force = true;
        last_ = valuesOf(config);
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
      assign(handler_(wanted), config);
      last_ = valuesOf(config);
    }
  }

  Handler handler_;
  boost::recursive_mutex mutex_;
  Values last_;  ///< in force, as the server writes them
  std::optional<dynamic_reconfigure::Server<ServedConfig>> server_;
};

ReconfigureServer::ReconfigureServer(const ros::NodeHandle& private_nh, const Values& in_force,
                                     Handler handler)
    : impl_(std::make_unique<Impl>(private_nh, in_force, std::move(handler))) {}

ReconfigureServer::~ReconfigureServer() = default;

}  // namespace fast_edi
