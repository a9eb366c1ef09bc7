#include "config/parameter_keys.hpp"
#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

/// Generous limits that catch a slipped decimal point.
constexpr NumberRange kCapacitorRatio{1.0, 1000.0};
constexpr NumberRange kKappa{0.1, 1.0};
constexpr NumberRange kCoarse{0.0, 7.0};
constexpr NumberRange kFine{0.0, 255.0};

using BiasMember = BiasSetting BiasConfiguration::*;
using NumberMember = double BiasConfiguration::*;

/// Coarse and fine of one bias. \param driver_name as the davis ROS driver spells it
void appendBias(const std::string& name, const std::string& driver_name, BiasMember member,
                const std::string& what, std::vector<ConfigKey>& keys) {
  const auto append = [&](const std::string& suffix, NumberRange range, int BiasSetting::*part,
                          const std::string& doc) {
    ConfigKey key = integerKey({name + suffix, "", "none", doc}, range,
                               [member, part](std::int64_t value, ParameterDraft& draft) {
                                 draft.biases.*member.*part = static_cast<int>(value);
                               });
    if (driver_name != name) {
      key.other_spellings.push_back(driver_name + suffix);
    }
    keys.push_back(std::move(key));
  };
  append("_coarse", kCoarse, &BiasSetting::coarse, "coarse value of " + what);
  append("_fine", kFine, &BiasSetting::fine, "fine value of " + what);
}

ConfigKey constantKey(const std::string& name, NumberRange range, NumberMember member,
                      const std::string& doc) {
  return numberKey({name, "", numberText(BiasConfiguration{}.*member), doc}, range,
                   [member](double value, ParameterDraft& draft) { draft.biases.*member = value; });
}

}  // namespace

std::vector<ConfigKey> biasKeys() {
  std::vector<ConfigKey> keys;
  appendBias("DiffBn", "DiffBn", &BiasConfiguration::diff, "the differencing amplifier's bias",
             keys);
  appendBias("OnBn", "ONBn", &BiasConfiguration::on, "the ON comparator's bias", keys);
  appendBias("OffBn", "OFFBn", &BiasConfiguration::off, "the OFF comparator's bias", keys);
  keys.push_back(choiceKey<CoarseConvention>(
      {"coarse_convention", "", "libcaer",
       "how coarse and fine values are read: as in libcaer and the ROS driver, or as in jAER's XML "
       "files, which store 7 - coarse"},
      {{"libcaer", CoarseConvention::kLibcaer}, {"jaer_xml", CoarseConvention::kJaerXml}},
      [](CoarseConvention value, ParameterDraft& draft) { draft.biases.convention = value; }));
  keys.push_back(constantKey("capacitor_ratio", kCapacitorRatio,
                             &BiasConfiguration::capacitor_ratio,
                             "C1/C2 of the pixel, known to about 10 %"));
  keys.push_back(constantKey("kappa_n", kKappa, &BiasConfiguration::kappa_n,
                             "back-gate coefficient of n-type transistors"));
  keys.push_back(constantKey("kappa_p", kKappa, &BiasConfiguration::kappa_p,
                             "back-gate coefficient of p-type transistors"));
  return keys;
}

}  // namespace fast_edi
