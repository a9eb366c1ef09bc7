/// \file
/// A parameter as a slider: whole positions from 0 on, and the value at each.
#pragma once

#include <string>

#include "fast_edi/config/parameter_table.hpp"

namespace fast_edi {

enum class SliderScale {
  kLinear,       ///< the step is added from position to position
  kLogarithmic,  ///< each value is (1 + step) times the one before
};

class Slider {
 public:
  /// \param parameter a number with limits; where 0 is accepted besides them, it is position 0
  /// \param step between positions: in the parameter's unit, or a share of the value
  /// \throws std::invalid_argument for a parameter without limits, a step that is not above 0, or
  ///         a logarithmic scale that does not begin above 0
  Slider(const ParameterDescription& parameter, SliderScale scale, double step);

  const std::string& name() const { return name_; }
  const std::string& unit() const { return unit_; }
  const std::string& doc() const { return doc_; }
  /// The highest one; the lowest is 0.
  int lastPosition() const { return last_; }
  /// Short: three significant digits, or those of the step; always within the limits.
  /// \param position is clipped to 0..lastPosition()
  double value(int position) const;
  /// The one whose value is nearest, on the slider's scale.
  int position(double value) const;

 private:
  double exactValue(int step) const;

  std::string name_;
  std::string unit_;
  std::string doc_;
  NumberRange limits_;
  SliderScale scale_;
  double step_;
  bool has_zero_;  ///< at position 0, before the lowest value
  int last_ = 0;
};

}  // namespace fast_edi
