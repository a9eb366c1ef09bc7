#include "fast_edi/base/parameter_ranges.hpp"

#include <stdexcept>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

constexpr int kTellingDigits = 9;

[[noreturn]] void refuse(const ParameterRange& parameter, double value) {
  const std::string unit = parameter.unit;
  throw std::invalid_argument(std::string(parameter.name) + " is " +
                              roundedText(value, kTellingDigits) + ", expected " +
                              parameter.range.text() + (unit.empty() ? "" : " [" + unit + "]"));
}

double asFloat(double value) {
  return static_cast<double>(static_cast<float>(value));
}

}  // namespace

std::string NumberRange::text() const {
  return (or_zero ? "0 or " : "") + numberText(lowest) + ".." + numberText(highest);
}

void requireWithin(const ParameterRange& parameter, double value) {
  if (!parameter.range.contains(value)) {
    refuse(parameter, value);
  }
}

void requireWithin(const ParameterRange& parameter, float value) {
  const NumberRange& range = parameter.range;
  const NumberRange rounded{asFloat(range.lowest), asFloat(range.highest), range.or_zero};
  if (!rounded.contains(static_cast<double>(value))) {
    refuse(parameter, static_cast<double>(value));
  }
}

void requireWithin(const ParameterRange& parameter, std::int64_t value_ns,
                   std::int64_t ns_per_unit) {
  const auto scale = static_cast<double>(ns_per_unit);
  const NumberRange& range = parameter.range;
  // As integers, since a double does not hold every nanosecond since 1970.
  const bool within = value_ns >= static_cast<std::int64_t>(range.lowest * scale) &&
                      value_ns <= static_cast<std::int64_t>(range.highest * scale);
  if (!within && !(range.or_zero && value_ns == 0)) {
    refuse(parameter, static_cast<double>(value_ns) / scale);
  }
}

}  // namespace fast_edi
