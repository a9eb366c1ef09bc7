#include "node/bias_update.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "fast_edi/calibration/contrast_from_bias.hpp"

namespace fast_edi {
namespace {

/// Spellings differ in case alone: ONBn in the driver, OnBn elsewhere.
bool equalIgnoringCase(const std::string& a, const std::string& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](unsigned char x, unsigned char y) {
           return std::tolower(x) == std::tolower(y);
         });
}

/// Collects biases from an update and notes which are missing.
class BiasFinder {
 public:
  explicit BiasFinder(const dynamic_reconfigure::Config& update) : update_(update) {}

  BiasSetting setting(const std::string& bias) {
    BiasSetting found;
    found.coarse = value(bias + "_coarse");
    found.fine = value(bias + "_fine");
    return found;
  }
  bool foundAny() const { return found_any_; }
  const std::string& missing() const { return missing_; }

 private:
  int value(const std::string& key) {
    const auto entry = std::find_if(
        update_.ints.begin(), update_.ints.end(),
        [&key](const auto& candidate) { return equalIgnoringCase(candidate.name, key); });
    if (entry == update_.ints.end()) {
      missing_ += (missing_.empty() ? "" : ", ") + key;
      return 0;
    }
    found_any_ = true;
    return entry->value;
  }

  const dynamic_reconfigure::Config& update_;
  std::string missing_;
  bool found_any_ = false;
};

}  // namespace

std::optional<ThresholdUpdate> thresholdsAfterBiasUpdate(
    const LoadedParameters& loaded, const dynamic_reconfigure::Config& update) {
  const NeededThresholds needed = loaded.from_biases;
  if (!needed.on && !needed.off) {
    return std::nullopt;
  }
  BiasConfiguration biases = loaded.biases.value_or(BiasConfiguration{});
  biases.convention = CoarseConvention::kLibcaer;
  BiasFinder finder(update);
  biases.diff = finder.setting("DiffBn");
  if (needed.on) {
    biases.on = finder.setting("ONBn");
  }
  if (needed.off) {
    biases.off = finder.setting("OFFBn");
  }
  if (!finder.foundAny()) {
    return std::nullopt;
  }
  if (!finder.missing().empty()) {
    throw std::invalid_argument("expected all biases in one update, found none of " +
                                finder.missing());
  }
  // Only a fine value of exactly 0; any other that cannot be is refused below.
  const bool off_assumed = needed.off && biases.off.fine == 0;
  const ContrastThresholds derived =
      contrastFromBias(biases, {needed.on, needed.off && !off_assumed});
  ThresholdUpdate result{loaded.deblur.thresholds, off_assumed};
  if (needed.on) {
    result.thresholds.on = derived.on;
  }
  if (off_assumed) {
    result.thresholds.off = result.thresholds.on;
  } else if (needed.off) {
    result.thresholds.off = derived.off;
  }
  return result;
}

}  // namespace fast_edi
