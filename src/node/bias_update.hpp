/// \file
/// Contrast thresholds that follow the biases which the davis driver has in force.
#pragma once

#include <optional>

#include <dynamic_reconfigure/Config.h>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

/// What biases in force at the driver make of the thresholds.
struct ThresholdUpdate {
  ContrastThresholds thresholds;
  /// OffBn has no current, as in davis_ros_driver's defaults, and says nothing: OFF is taken to be
  /// as sensitive as ON.
  bool off_assumed = false;
};

/// The thresholds of \p loaded with its biases replaced by the driver's, which are in libcaer's
/// convention. An explicit threshold still wins.
/// \returns nothing when \p update carries no bias at all, or no bias has a say
/// \throws std::invalid_argument when it carries only some of the biases needed, or values for
///         which there is no threshold, but for an OffBn without current
std::optional<ThresholdUpdate> thresholdsAfterBiasUpdate(const LoadedParameters& loaded,
                                                         const dynamic_reconfigure::Config& update);

}  // namespace fast_edi
