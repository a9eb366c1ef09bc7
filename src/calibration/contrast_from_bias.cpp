#include "fast_edi/calibration/contrast_from_bias.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include "fast_edi/base/number_text.hpp"
#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {
namespace {

constexpr int kMaxCoarse = 7;
constexpr int kMaxFine = 255;

/// libcaer src/davis.c [pA], not rounded to whole pA after multiplying by fine / 255.
constexpr std::array<double, kMaxCoarse + 1> kLibcaerCurrents_pA = {
    11.0, 94.0, 756.0, 6054.0, 48437.0, 387500.0, 3100000.0, 24800000.0};
constexpr double kAmperePerPicoampere = 1e-12;
constexpr double kLibcaerFineDivisor = 255.0;

/// jAER's AddressedIPotCF: I = 389 nA * 8^(coarse - 5) * fine / 256.
constexpr double kJaerMasterCurrent_A = 389e-9;
constexpr double kJaerCoarseRatio = 8.0;
constexpr int kJaerMasterCoarse = 5;
constexpr double kJaerFineDivisor = 256.0;

/// Thresholds that a DAVIS is normally run with [natural log].
constexpr double kUsualMinimum = 0.05;
constexpr double kUsualMaximum = 0.6;
constexpr double kUsualMinimumRatio = 0.5;
constexpr double kUsualMaximumRatio = 2.0;

std::string format(double value) {
  constexpr int kDigits = 4;
  return roundedText(value, kDigits);
}

std::string describe(const char* name, const BiasSetting& bias) {
  return std::string(name) + " (coarse " + std::to_string(bias.coarse) + ", fine " +
         std::to_string(bias.fine) + ")";
}

/// What is wrong with the numbers of one bias; empty if nothing is.
std::string rangeFault(const BiasSetting& bias) {
  if (bias.coarse < 0 || bias.coarse > kMaxCoarse) {
    return "coarse is " + std::to_string(bias.coarse) + ", expected 0..7";
  }
  if (bias.fine < 0 || bias.fine > kMaxFine) {
    return "fine is " + std::to_string(bias.fine) + ", expected 0..255";
  }
  return {};
}

[[noreturn]] void fail(const std::vector<std::string>& faults) {
  std::string text;
  for (const std::string& fault : faults) {
    text += (text.empty() ? "" : "\n") + fault;
  }
  throw std::invalid_argument(text);
}

/// \throws std::invalid_argument when no such threshold can be set
void requireFromBiases(const ParameterRange& parameter, double threshold) {
  try {
    requireWithin(parameter, threshold);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("from these biases ") + error.what());
  }
}

void warnIfUnusual(const char* name, double threshold, std::vector<std::string>& warnings) {
  if (threshold < kUsualMinimum || threshold > kUsualMaximum) {
    warnings.push_back(std::string(name) + " is " + format(threshold) + ", usual are " +
                       format(kUsualMinimum) + " to " + format(kUsualMaximum) + " (natural log)");
  }
}

}  // namespace

double biasCurrent(const BiasSetting& bias, CoarseConvention convention) {
  const std::string fault = rangeFault(bias);
  if (!fault.empty()) {
    throw std::invalid_argument("bias " + fault);
  }
  if (convention == CoarseConvention::kJaerXml) {
    const int coarse = kMaxCoarse - bias.coarse;
    return kJaerMasterCurrent_A * std::pow(kJaerCoarseRatio, coarse - kJaerMasterCoarse) *
           bias.fine / kJaerFineDivisor;
  }
  return kLibcaerCurrents_pA[static_cast<std::size_t>(bias.coarse)] * kAmperePerPicoampere *
         bias.fine / kLibcaerFineDivisor;
}

double contrastGain(const BiasConfiguration& configuration) {
  std::vector<std::string> faults;
  const auto check = [&faults](const char* name, double value) {
    if (!(std::isfinite(value) && value > 0.0)) {
      faults.push_back(std::string(name) + " is " + format(value) +
                       ", expected a finite number > 0");
    }
  };
  check("capacitor_ratio", configuration.capacitor_ratio);
  check("kappa_n", configuration.kappa_n);
  check("kappa_p", configuration.kappa_p);
  if (!faults.empty()) {
    fail(faults);
  }
  return configuration.kappa_n /
         (configuration.kappa_p * configuration.kappa_p * configuration.capacitor_ratio);
}

ContrastThresholds contrastFromBias(const BiasConfiguration& configuration,
                                    NeededThresholds needed) {
  const double gain = contrastGain(configuration);
  std::vector<std::string> faults;
  const auto current = [&](const char* name, const BiasSetting& bias) {
    const std::string fault = rangeFault(bias);
    if (!fault.empty()) {
      faults.push_back(std::string(name) + ": " + fault);
      return 0.0;
    }
    return biasCurrent(bias, configuration.convention);
  };
  const double diff = current("DiffBn", configuration.diff);
  const double on = current("OnBn", configuration.on);
  const double off = current("OffBn", configuration.off);
  if (!faults.empty()) {
    fail(faults);
  }

  const std::string diff_name = describe("DiffBn", configuration.diff);
  if (!(diff > 0.0)) {
    faults.push_back(diff_name + " has no current, expected I_d > 0");
  } else {
    if (needed.on && !(diff < on)) {
      faults.push_back(describe("OnBn", configuration.on) + " is not above " + diff_name + " (" +
                       format(on) + " A, " + format(diff) + " A), expected I_d < I_ON");
    }
    if (needed.off && !(off > 0.0)) {
      faults.push_back(describe("OffBn", configuration.off) +
                       " has no current, so that the biases say nothing about the OFF threshold: "
                       "expected I_OFF > 0, or give contrast_threshold_off");
    } else if (needed.off && !(off < diff)) {
      faults.push_back(describe("OffBn", configuration.off) + " is not below " + diff_name + " (" +
                       format(off) + " A, " + format(diff) + " A), expected I_OFF < I_d");
    }
  }
  if (!faults.empty()) {
    fail(faults);
  }

  ContrastThresholds thresholds;
  if (needed.on) {
    thresholds.on = gain * std::log(on / diff);
    requireFromBiases(limits::kContrastOn, thresholds.on);
  }
  if (needed.off) {
    thresholds.off = -gain * std::log(off / diff);
    requireFromBiases(limits::kContrastOff, thresholds.off);
  }
  return thresholds;
}

std::vector<std::string> contrastWarnings(const ContrastThresholds& thresholds) {
  std::vector<std::string> warnings;
  warnIfUnusual("the ON contrast threshold", thresholds.on, warnings);
  warnIfUnusual("the OFF contrast threshold", thresholds.off, warnings);
  const double ratio = thresholds.on / thresholds.off;
  if (ratio < kUsualMinimumRatio || ratio > kUsualMaximumRatio) {
    warnings.push_back("the ratio of ON to OFF contrast threshold is " + format(ratio) +
                       ", usual are " + format(kUsualMinimumRatio) + " to " +
                       format(kUsualMaximumRatio));
  }
  return warnings;
}

}  // namespace fast_edi
