#include "node/parameters_in_force.hpp"

#include <exception>
#include <stdexcept>
#include <utility>

#include <ros/console.h>

#include "fast_edi/base/number_text.hpp"
#include "fast_edi/calibration/contrast_from_bias.hpp"
#include "node/bias_update.hpp"

namespace fast_edi {

ParametersInForce::ParametersInForce(const YAML::Node& root, std::string name,
                                     std::string bias_topic, Apply apply)
    : name_(std::move(name)),
      bias_topic_(std::move(bias_topic)),
      apply_(std::move(apply)),
      in_force_(parametersFromYaml(root, "")),
      as_set_(in_force_, root) {}

void ParametersInForce::logContrast() const {
  const ContrastThresholds& thresholds = in_force_.deblur.thresholds;
  ROS_INFO_STREAM(name_ << ": contrast thresholds ON " << numberText(thresholds.on) << ", OFF "
                        << numberText(thresholds.off) << " from " << in_force_.contrast_origin);
  for (const std::string& warning : in_force_.warnings) {
    ROS_WARN_STREAM(name_ << ": " << warning);
  }
}

ParametersInForce::Refusals ParametersInForce::change(const Values& wanted) {
  LiveParameters next = as_set_;
  Refusals refusals;
  refusals.values = next.change(wanted);
  for (const std::string& refusal : refusals.values) {
    ROS_WARN_STREAM(name_ << ": old value kept: " << refusal);
  }
  try {
    LoadedParameters parameters = next.loaded();
    std::string bias_refusal;
    try {
      parameters = withBiases(next.loaded(), driver_biases_);
    } catch (const std::invalid_argument& error) {
      bias_refusal = error.what();
    }
    putInForce(std::move(parameters));
    as_set_ = std::move(next);
    if (!bias_refusal.empty()) {
      refusals.biases = bias_refusal;
      driver_biases_.reset();
    }
  } catch (const std::exception& error) {
    refusals.request = error.what();
    ROS_WARN_STREAM(name_ << ": old values kept: " << error.what());
  }
  return refusals;
}

std::string ParametersInForce::followBiases(const dynamic_reconfigure::ConfigConstPtr& biases) {
  try {
    LoadedParameters next = withBiases(as_set_.loaded(), biases);
    if (next.deblur.thresholds != in_force_.deblur.thresholds) {
      putInForce(std::move(next));
    }
    driver_biases_ = biases;
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

/// The same parameters with thresholds from the driver's biases where these decide them.
/// \param biases may be null
/// \throws std::invalid_argument when there is no threshold for them
LoadedParameters ParametersInForce::withBiases(
    LoadedParameters parameters, const dynamic_reconfigure::ConfigConstPtr& biases) const {
  if (biases) {
    const auto update = thresholdsAfterBiasUpdate(parameters, *biases);
    if (update) {
      parameters.deblur.thresholds = update->thresholds;
      parameters.contrast_origin = "biases on " + bias_topic_;
      parameters.warnings = contrastWarnings(update->thresholds);
      if (update->off_assumed) {
        parameters.contrast_origin += ", OFF assumed to be as ON";
        parameters.warnings.push_back(
            "OffBn of the driver has no current (fine value 0), so that its biases say nothing "
            "about the OFF threshold: taken to be that of ON, " +
            numberText(update->thresholds.off) +
            "; set OFFBn_fine above 0 in the driver, or give contrast_threshold_off");
      }
    }
  }
  return parameters;
}

void ParametersInForce::putInForce(LoadedParameters parameters) {
  apply_(parameters.deblur);
  const bool contrast_changes = parameters.deblur.thresholds != in_force_.deblur.thresholds ||
                                parameters.contrast_origin != in_force_.contrast_origin;
  in_force_ = std::move(parameters);
  if (contrast_changes) {
    logContrast();
  }
}

}  // namespace fast_edi
