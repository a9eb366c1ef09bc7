#include "fast_edi/config/tag_detector_parameters.hpp"

#include <utility>

#include "config_faults.hpp"
#include "config_key.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "parameter_draft.hpp"

namespace fast_edi {
namespace {

constexpr NumberRange kTagSize_m{0.0, 100.0, true};
constexpr NumberRange kDecimate{1.0, 16.0};
constexpr NumberRange kThreads{1.0, 64.0};
constexpr NumberRange kCorrectedBits{0.0, 2.0};

std::string boolText(bool value) {
  return value ? "true" : "false";
}

/// \param read where values go; must outlive the keys
std::vector<ConfigKey> keysOf(TagDetectorParameters& read) {
  const TagDetectorParameters defaults;
  std::vector<std::pair<std::string, std::string>> families;
  for (const char* family : kTagFamilies) {
    families.emplace_back(family, family);
  }
  return {
      choiceKey<std::string>(
          {"family", "", defaults.detector.family, "family of the tags"}, families,
          [&read](const std::string& value, ParameterDraft&) { read.detector.family = value; }),
      numberKey({"tag_size_m", "m", numberText(defaults.tag_size_m),
                 "side of the tag's outline, of the black square in most families; distances "
                 "follow from it"},
                kTagSize_m, [&read](double value, ParameterDraft&) { read.tag_size_m = value; }),
      numberKey({"decimate", "", numberText(defaults.detector.decimate),
                 "tags are searched in a frame smaller by this factor: faster, and small tags are "
                 "missed"},
                kDecimate,
                [&read](double value, ParameterDraft&) { read.detector.decimate = value; }),
      integerKey({"threads", "", numberText(defaults.detector.threads), "threads that search"},
                 kThreads,
                 [&read](std::int64_t value, ParameterDraft&) {
                   read.detector.threads = static_cast<int>(value);
                 }),
      integerKey({"corrected_bits", "bits", numberText(defaults.detector.corrected_bits),
                  "wrong bits that are corrected; fewer give fewer false tags. The largest "
                  "families take at most 1"},
                 kCorrectedBits,
                 [&read](std::int64_t value, ParameterDraft&) {
                   read.detector.corrected_bits = static_cast<int>(value);
                 }),
      boolKey({"rectified", "", boolText(defaults.rectified),
               "the images are rectified, as `image_proc` gives them"},
              [&read](bool value, ParameterDraft&) { read.rectified = value; }),
      textKey({"frame_id", "", "\"\"", "replaces an empty frame_id of the images"},
              [&read](const std::string& value, ParameterDraft&) { read.frame_id = value; }),
      boolKey({"lazy", "", boolText(defaults.lazy),
               "subscribe to the images only while somebody subscribes to an output"},
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
