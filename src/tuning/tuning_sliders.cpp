#include "tuning/tuning_sliders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {
namespace {

constexpr double kTimeStep_us = 100.0;

struct Row {
  const char* name;
  SliderScale scale;
  double step;
};

/// Shares of a value that make a difference that can be seen, and hundredths of weights.
constexpr std::array<Row, 10> kRows{{
    {limits::kContrastOn.name, SliderScale::kLogarithmic, 0.02},
    {limits::kContrastOff.name, SliderScale::kLogarithmic, 0.02},
    {limits::kExposureTime.name, SliderScale::kLinear, kTimeStep_us},
    {limits::kTimeOffset.name, SliderScale::kLinear, kTimeStep_us},
    {limits::kFilterGainNoise.name, SliderScale::kLogarithmic, 0.05},
    {limits::kFilterGainSigma.name, SliderScale::kLogarithmic, 0.05},
    {limits::kFilterGainRestore.name, SliderScale::kLinear, 0.01},
    {limits::kFilterFrameNoiseKept.name, SliderScale::kLinear, 0.01},
    {limits::kFilterTemporal.name, SliderScale::kLinear, 0.01},
    {limits::kFrameNoise.name, SliderScale::kLogarithmic, 0.05},
}};

ParameterDescription descriptionOf(const std::string& name) {
  for (ParameterDescription& description : parameterDescriptions()) {
    if (description.name == name) {
      return description;
    }
  }
  throw std::logic_error(name + " is no parameter");
}

/// \p limits without what lies outside of \p lowest to \p highest.
NumberRange within(const NumberRange& limits, double lowest, double highest) {
  return {std::max(limits.lowest, lowest), std::min(limits.highest, highest), false};
}

}  // namespace

std::vector<Slider> tuningSliders(const TuningRanges& ranges) {
  std::vector<Slider> sliders;
  for (const Row& row : kRows) {
    ParameterDescription parameter = descriptionOf(row.name);
    if (parameter.name == limits::kExposureTime.name) {
      if (ranges.exposures_known) {
        continue;
      }
      const double longest_us = ranges.longest_exposure_us > 0
                                    ? static_cast<double>(ranges.longest_exposure_us)
                                    : parameter.limits->highest;
      parameter.limits =
          within(*parameter.limits, kTimeStep_us, std::max(longest_us, 2.0 * kTimeStep_us));
    } else if (parameter.name == limits::kTimeOffset.name) {
      const double middle_us = kTimeStep_us * std::round(ranges.time_offset_us / kTimeStep_us);
      parameter.limits =
          within(*parameter.limits, middle_us - kOffsetRange_us, middle_us + kOffsetRange_us);
    }
    sliders.emplace_back(parameter, row.scale, row.step);
  }
  return sliders;
}

}  // namespace fast_edi
