/// \file
/// The two keys whose values may come from biases instead.
#pragma once

#include <string>

#include "fast_edi/calibration/contrast_from_bias.hpp"

namespace fast_edi {

constexpr const char* kContrastOn = "contrast_threshold_on";
constexpr const char* kContrastOff = "contrast_threshold_off";
constexpr const char* kBiases = "biases";

/// LoadedParameters::contrast_origin.
std::string contrastOrigin(NeededThresholds from_biases);

}  // namespace fast_edi
