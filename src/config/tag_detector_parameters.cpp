#include "fast_edi/config/tag_detector_parameters.hpp"

#include <utility>

#include "config/config_faults.hpp"
#include "config/config_key.hpp"
#include "config/parameter_draft.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

constexpr NumberRange kTagSize_m{0.001, 100.0};
constexpr NumberRange kDecimate{1.0, 16.0};
constexpr NumberRange kThreads{1.0, 64.0};
constexpr NumberRange kCorrectedBits{0.0, 2.0};

/// \param read where values go; must outlive the keys
std::vector<ConfigKey> keysOf(TagDetectorParameters& read) {
  const TagDetectorParameters defaults;
  std::vector<std::pair<std::string, std::string>> families;
  for (const char* family : kTagFamilies) {
    families.emplace_back(family, family);
  }
  return {
      choiceKey<std::string>(
          {"family", "", defaults.detector.family, "tag family"}, families,
          [&read](const std::string& value, ParameterDraft&) { read.detector.family = value; }),
      numberKey({"tag_size_m", "m", numberText(defaults.tag_size_m),
                 "side length of the tag's outline, which is the black square in most families; "
                 "determines distances"},
                kTagSize_m, [&read](double value, ParameterDraft&) { read.tag_size_m = value; }),
      numberKey({"decimate", "", numberText(defaults.detector.decimate),
                 "factor by which the frame is shrunk before the search: faster, but small tags "
                 "are missed"},
                kDecimate,
                [&read](double value, ParameterDraft&) { read.detector.decimate = value; }),
      integerKey({"threads", "", numberText(defaults.detector.threads),
                  "number of threads for the search"},
                 kThreads,
                 [&read](std::int64_t value, ParameterDraft&) {
                   read.detector.threads = static_cast<int>(value);
                 }),
      integerKey({"corrected_bits", "bits", numberText(defaults.detector.corrected_bits),
                  "number of wrong bits to correct; fewer give fewer false detections. The largest "
                  "families allow at most 1"},
                 kCorrectedBits,
                 [&read](std::int64_t value, ParameterDraft&) {
                   read.detector.corrected_bits = static_cast<int>(value);
                 }),
      boolKey({"rectified", "", boolText(defaults.rectified),
               "the images are already rectified, for instance by `image_proc`"},
              [&read](bool value, ParameterDraft&) { read.rectified = value; }),
      textKey({"frame_id", "", "\"\"", "`frame_id` of the output if that of the images is empty"},
              [&read](const std::string& value, ParameterDraft&) { read.frame_id = value; }),
      boolKey({"lazy", "", boolText(defaults.lazy),
               "subscribe to the images only while an output has a subscriber"},
              [&read](bool value, ParameterDraft&) { read.lazy = value; }),
  };
}

}  // namespace

TagDetectorParameters tagDetectorParametersFromYaml(const YAML::Node& root) {
  ConfigFaults faults;
  if (!root.IsMap() && !root.IsNull()) {
    faults.add(root, "the configuration is " + foundText(root) + ", expected a map");
    throw ParameterError(faults.text());
  }
  TagDetectorParameters parameters;
  ParameterDraft draft;
  readMap(root, keysOf(parameters), "", draft, faults);
  if (!faults.empty()) {
    throw ParameterError(faults.text());
  }
  return parameters;
}

std::vector<ParameterDescription> tagDetectorDescriptions() {
  TagDetectorParameters unused;
  std::vector<ParameterDescription> descriptions;
  for (const ConfigKey& key : keysOf(unused)) {
    descriptions.push_back(key.description);
  }
  return descriptions;
}

}  // namespace fast_edi
