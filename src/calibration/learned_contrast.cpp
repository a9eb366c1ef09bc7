#include "calibration/learned_contrast.hpp"

#include <algorithm>
#include <cmath>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

constexpr int kDecimals = 3;

double deviation(double given, double learned) {
  return std::abs(learned / given - 1.0);
}

std::string pairText(const ContrastThresholds& thresholds) {
  return fixedText(thresholds.on, kDecimals) + ", " + fixedText(thresholds.off, kDecimals);
}

}  // namespace

std::string learnedContrastRemark(const ContrastThresholds& given,
                                  const ContrastThresholds& learned, std::uint64_t fits) {
  const double largest =
      std::max(deviation(given.on, learned.on), deviation(given.off, learned.off));
  if (fits < kLeastFits || largest < kWrongContrast) {
    return {};
  }
  return "contrast thresholds look wrong: " + pairText(given) + " (ON, OFF) given, " +
         pairText(learned) + " learned:\nvalidate_bag measures them, tune sets them by eye";
}

}  // namespace fast_edi
