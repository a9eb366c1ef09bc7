/// What users write: YAML files, overrides on the command line, camera response files, and the
/// driver's biases.
///
/// Input: one byte for the kind, then the text (for overrides: one line each).
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <dynamic_reconfigure/Config.h>
#include <fuzzer/FuzzedDataProvider.h>

#include "fast_edi/calibration/contrast_from_bias.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/latent/camera_response.hpp"
#include "fuzz/fuzzing.hpp"
#include "node/bias_update.hpp"
#include "support/temporary_directory.hpp"

namespace {

using fast_edi::LoadedParameters;
using fast_edi::ParameterError;
using fast_edi::fuzzing::require;

const fast_edi::TemporaryDirectory& directory() {
  static const fast_edi::TemporaryDirectory directory;
  return directory;
}

/// \return the path
std::string writeFile(const char* name, const std::string& text) {
  const std::string path = directory().file(name);
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

void requireUsable(const LoadedParameters& loaded) {
  fast_edi::validate(loaded.deblur);  // an exception is a finding
  require(!loaded.contrast_origin.empty(),
          "accepted parameters say where their thresholds are from");
}

void loadFile(const std::string& text, const std::vector<std::string>& overrides) {
  const std::string path = writeFile("parameters.yaml", text);
  try {
    requireUsable(fast_edi::parametersFromFile(path, overrides));
  } catch (const ParameterError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(stream, line);) {
    result.push_back(line);
  }
  return result;
}

void loadResponse(const std::string& text) {
  try {
    const fast_edi::CameraResponse response =
        fast_edi::CameraResponse::fromFile(writeFile("response.txt", text));
    for (int dn = 0; dn <= UINT8_MAX; ++dn) {
      const double exposure = response.exposure(dn);
      require(std::isfinite(exposure) && exposure >= 0.0, "exposures are finite");
    }
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

void updateBiases(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider input(data, size);
  LoadedParameters loaded;
  loaded.from_biases = {input.ConsumeBool(), input.ConsumeBool()};
  loaded.deblur.thresholds = {0.3, 0.2};
  const std::vector<std::string> names{"DiffBn_coarse", "DiffBn_fine",  "ONBn_coarse",
                                       "ONBn_fine",     "OFFBn_coarse", "offbn_FINE"};
  dynamic_reconfigure::Config update;
  while (input.remaining_bytes() > 0) {
    dynamic_reconfigure::IntParameter parameter;
    const auto name = input.ConsumeIntegralInRange<std::size_t>(0, names.size());
    parameter.name = name < names.size() ? names[name] : input.ConsumeRandomLengthString(UINT8_MAX);
    parameter.value = input.ConsumeBool() ? input.ConsumeIntegral<std::uint8_t>()
                                          : input.ConsumeIntegral<std::int32_t>();
    update.ints.push_back(parameter);
  }
  try {
    const auto found = fast_edi::thresholdsAfterBiasUpdate(loaded, update);
    if (found) {
      fast_edi::DeblurParameters changed = loaded.deblur;
      changed.thresholds = found->thresholds;
      fast_edi::validate(changed);
    }
  } catch (const std::invalid_argument& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0]) {
    case 'o':
      loadFile("contrast_threshold_on: 0.3\ncontrast_threshold_off: 0.3\n", lines(text));
      break;
    case 'r':
      loadResponse(text);
      break;
    case 'b':
      updateBiases(data + 1, size - 1);
      break;
    default:
      loadFile(text, {"lazy:=false", "biases/DiffBn_coarse:=3"});
      loadFile(text, {});
      break;
  }
  return 0;
}
