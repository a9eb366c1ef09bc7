/// \file
/// Contrast thresholds from the bias settings of a DAVIS.
///
///     C_x = K ln(I_x / I_d),   K = kappa_n / (kappa_p^2 * C1/C2),   x in {ON, OFF}
///
/// (Nozaki & Delbruck, "Temperature and Parasitic Photocurrent Effects in Dynamic Vision Sensors",
/// 2017; Lin et al., ICRA 2023.) I_d, I_ON, I_OFF: currents of DiffBn, OnBn, OffBn [A]; kappa:
/// back-gate coefficients; C1/C2: capacitor ratio, known to about 10 %. C_OFF comes out negative
/// and is returned as a positive ContrastThresholds::off.
#pragma once

#include <string>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"

namespace fast_edi {

/// One bias as drivers store it.
struct BiasSetting {
  int coarse = 0;  ///< 0..7
  int fine = 0;    ///< 0..255
};

/// Which table turns coarse and fine into a current.
enum class CoarseConvention {
  /// libcaer's table [pA] * fine / 255 (the ROS driver)
  kLibcaer,
  /// jAER's XML: 389 nA * 8^(coarse - 5) * fine / 256, the coarse value stored flipped (7 - coarse)
  kJaerXml,
};

struct BiasConfiguration {
  BiasSetting diff;  ///< DiffBn
  BiasSetting on;    ///< OnBn
  BiasSetting off;   ///< OffBn
  CoarseConvention convention = CoarseConvention::kLibcaer;
  double capacitor_ratio = 130.0 / 6.0;  ///< C1/C2 (DAVIS346 in Lin et al.)
  double kappa_n = 0.7;
  double kappa_p = 0.7;
};

/// Bias current [A].
/// \throws std::invalid_argument unless coarse is 0..7 and fine 0..255
double biasCurrent(const BiasSetting& bias, CoarseConvention convention);

/// K of the equation above. \throws std::invalid_argument unless all three inputs are finite
/// and > 0
double contrastGain(const BiasConfiguration& configuration);

/// Which of the two thresholds are needed; the other may be given explicitly.
struct NeededThresholds {
  bool on = true;
  bool off = true;
};

/// A threshold that is not needed comes back as 0, and only the ranges of its bias are checked.
/// \throws std::invalid_argument naming the bias and the rule, one line each: coarse 0..7,
///         fine 0..255, I_d > 0, I_OFF < I_d < I_ON, I_OFF > 0 (the stock ROS driver ships OffBn
///         fine = 0: no value)
ContrastThresholds contrastFromBias(const BiasConfiguration& configuration,
                                    NeededThresholds needed = {});

/// Unusual thresholds: |C| < 0.05 or > 0.6, |C_ON / C_OFF| outside 0.5..2.
std::vector<std::string> contrastWarnings(const ContrastThresholds& thresholds);

}  // namespace fast_edi
