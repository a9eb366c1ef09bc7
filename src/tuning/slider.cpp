#include "tuning/slider.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

constexpr int kDigits = 3;
/// More positions than pixels of any screen are of no use; also keeps int from overflowing.
constexpr double kMostSteps = 1e5;

/// The nearest number that people would write.
double shortened(double value) {
  return *parseNumber(roundedText(value, kDigits));
}

/// The nearest multiple of \p step, as the number that its text stands for.
double onGrid(double value, double step) {
  if (step >= 1.0) {
    return step * std::round(value / step);
  }
  const double per_unit = std::round(1.0 / step);
  return std::round(value * per_unit) / per_unit;
}

}  // namespace

Slider::Slider(const ParameterDescription& parameter, SliderScale scale, double step)
    : name_(parameter.name),
      unit_(parameter.unit),
      doc_(parameter.doc),
      limits_(parameter.limits.value_or(NumberRange{})),
      scale_(scale),
      step_(step) {
  const bool logarithmic = scale == SliderScale::kLogarithmic;
  if (!parameter.limits || !(step > 0.0) || !(limits_.lowest < limits_.highest) ||
      (logarithmic && !(limits_.lowest > 0.0))) {
    throw std::invalid_argument("no slider can be made of " + name_ + " (" + limits_.text() +
                                ") in steps of " + numberText(step));
  }
  const double steps = logarithmic ? std::log(limits_.highest / limits_.lowest) / std::log1p(step)
                                   : (limits_.highest - limits_.lowest) / step;
  has_zero_ = limits_.or_zero && limits_.lowest > 0.0;
  // What is left of a step at the upper end is one of its own; rounding leaves none.
  constexpr double kRounding = 1e-6;
  last_ =
      static_cast<int>(std::ceil(std::min(steps, kMostSteps) - kRounding)) + (has_zero_ ? 1 : 0);
}

double Slider::exactValue(int step) const {
  return scale_ == SliderScale::kLogarithmic ? limits_.lowest * std::pow(1.0 + step_, step)
                                             : limits_.lowest + step * step_;
}

double Slider::value(int position) const {
  int step = std::clamp(position, 0, last_);
  if (has_zero_) {
    if (step == 0) {
      return 0.0;
    }
    --step;
  }
  const double exact = exactValue(step);
  const double rounded =
      scale_ == SliderScale::kLogarithmic ? shortened(exact) : onGrid(exact, step_);
  return std::clamp(rounded, limits_.lowest, limits_.highest);
}

int Slider::position(double value) const {
  if (has_zero_ && value < limits_.lowest / 2.0) {
    return 0;
  }
  const double within = std::clamp(value, limits_.lowest, limits_.highest);
  const double steps = scale_ == SliderScale::kLogarithmic
                           ? std::log(within / limits_.lowest) / std::log1p(step_)
                           : (within - limits_.lowest) / step_;
  const int position = static_cast<int>(std::lround(steps)) + (has_zero_ ? 1 : 0);
  return std::clamp(position, 0, last_);
}

}  // namespace fast_edi
