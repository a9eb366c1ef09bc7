/// \file
/// Whether the contrast thresholds that were given can be right, by those that were learned.
///
/// Learning ends at 30 % from the given ones (see OnlineCalibration). What is learned close to that
/// end would be beyond it, and images are deblurred with thresholds that are known to be wrong.
#pragma once

#include <cstdint>
#include <string>

#include "fast_edi/base/contrast_threshold.hpp"

namespace fast_edi {

/// Thresholds that were learned at least this far from the given ones, relative to these, say that
/// those are wrong.
constexpr double kWrongContrast = 0.25;
/// Fewer pairs of frames say nothing.
constexpr std::uint64_t kLeastFits = 5;

/// For people, two lines: what is wrong, and which tools to use. Empty if the given thresholds may
/// be right. \param fits pairs of frames that it was learned from
std::string learnedContrastRemark(const ContrastThresholds& given,
                                  const ContrastThresholds& learned, std::uint64_t fits);

}  // namespace fast_edi
