#include "rostest/fake_driver.hpp"

#include <limits>

#include <dynamic_reconfigure/ConfigDescription.h>

namespace fast_edi {
namespace test {
namespace {

void append(const std::string& name, const std::string& type, int value,
            dynamic_reconfigure::Config& config) {
  if (type == "int") {
    dynamic_reconfigure::IntParameter parameter;
    parameter.name = name;
    parameter.value = value;
    config.ints.push_back(parameter);
  } else {
    dynamic_reconfigure::BoolParameter parameter;
    parameter.name = name;
    parameter.value = value != 0;
    config.bools.push_back(parameter);
  }
}

}  // namespace

FakeDriver::FakeDriver(const std::string& node, const std::map<std::string, std::string>& settings)
    : nh_(node) {
  dynamic_reconfigure::ConfigDescription description;
  description.groups.resize(1);
  description.groups[0].name = "Default";
  for (const auto& [name, type] : settings) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = name;
    parameter.type = type;
    description.groups[0].parameters.push_back(parameter);
    append(name, type, 0, description.dflt);
    append(name, type, 0, description.min);
    append(name, type, std::numeric_limits<int>::max(), description.max);
  }
  descriptions_ =
      nh_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  descriptions_.publish(description);
  updates_ = nh_.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true);
  updates_.publish(dynamic_reconfigure::Config());
  server_ = nh_.advertiseService("set_parameters", &FakeDriver::receive, this);
}

std::map<std::string, int> FakeDriver::set() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return set_;
}

void FakeDriver::announce(const std::map<std::string, int>& integers) {
  dynamic_reconfigure::Config update;
  for (const auto& [name, value] : integers) {
    append(name, "int", value, update);
  }
  updates_.publish(update);
}

bool FakeDriver::receive(dynamic_reconfigure::Reconfigure::Request& request,
                         dynamic_reconfigure::Reconfigure::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& parameter : request.config.ints) {
    set_[parameter.name] = parameter.value;
  }
  for (const auto& parameter : request.config.bools) {
    set_[parameter.name] = parameter.value ? 1 : 0;
  }
  response.config = request.config;
  return true;
}

}  // namespace test
}  // namespace fast_edi
