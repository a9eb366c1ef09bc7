/// \file
/// The gains that the double integral gives lie within these, far beyond what any image can show.
#pragma once

namespace fast_edi {

constexpr double kMinGain = 1e-30;
constexpr double kMaxGain = 1e30;

}  // namespace fast_edi
