/// \file
/// Numbers as text and back, the same under every locale: a point before decimals, nothing between
/// thousands. A nodelet shares its process with others, any of which may set a locale.
#pragma once

#include <optional>
#include <string>

namespace fast_edi {

/// At most \p digits significant digits, like printf's %g.
std::string roundedText(double value, int digits);

/// Exactly \p decimals digits after the point, like printf's %f.
std::string fixedText(double value, int decimals);

/// For people: integers in full up to 1e15, else at most six digits.
std::string numberText(double value);

/// No more digits than it takes to read the same number back, at most 17.
/// \pre \p value is finite
std::string exactText(double value);

/// \return nothing unless \p text as a whole is one decimal number that a double can hold
std::optional<double> parseNumber(const std::string& text);

}  // namespace fast_edi
