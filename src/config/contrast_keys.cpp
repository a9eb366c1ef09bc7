#include "config/contrast_keys.hpp"

#include <utility>

namespace fast_edi {

std::string contrastOrigin(NeededThresholds from_biases) {
  std::string text = from_biases.on || from_biases.off ? kBiases : "";
  for (const auto& [key, derived] : {std::make_pair(kContrastOn, from_biases.on),
                                     std::make_pair(kContrastOff, from_biases.off)}) {
    if (!derived) {
      text += (text.empty() ? "" : ", ") + std::string(key);
    }
  }
  return text;
}

}  // namespace fast_edi
