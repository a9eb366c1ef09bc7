#include "fast_edi/base/number_text.hpp"

#include <cmath>
#include <ios>
#include <locale>
#include <sstream>

namespace fast_edi {
namespace {

constexpr double kLargestPlainInteger = 1e15;
constexpr int kUsualDigits = 6;
constexpr int kMostCertainDigits = 15;  ///< every double survives the way to text and back
constexpr int kAllDigits = 17;

std::ostringstream classicStream() {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  return stream;
}

}  // namespace

std::string roundedText(double value, int digits) {
  std::ostringstream text = classicStream();
  text.precision(digits);
  text << value;
  return text.str();
}

std::string fixedText(double value, int decimals) {
  std::ostringstream text = classicStream();
  text.precision(decimals);
  text << std::fixed << value;
  return text.str();
}

std::string numberText(double value) {
  const bool integer = std::abs(value) < kLargestPlainInteger && value == std::floor(value);
  return integer ? fixedText(value, 0) : roundedText(value, kUsualDigits);
}

std::string exactText(double value) {
  const std::string text = roundedText(value, kMostCertainDigits);
  return parseNumber(text) == value ? text : roundedText(value, kAllDigits);
}

std::optional<double> parseNumber(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (stream >> std::noskipws >> value && stream.peek() == std::istringstream::traits_type::eof()) {
    return value;
  }
  return std::nullopt;
}

}  // namespace fast_edi
