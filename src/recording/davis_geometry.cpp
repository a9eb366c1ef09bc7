#include "recording/davis_geometry.hpp"

#include <cctype>

namespace fast_edi {

std::optional<SensorSize> davisSize(const std::string& name) {
  std::string upper;
  for (const char c : name) {
    upper += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  if (upper.find("DAVIS240") != std::string::npos) {
    return SensorSize{240, 180};
  }
  if (upper.find("DAVIS346") != std::string::npos) {
    return SensorSize{346, 260};
  }
  return std::nullopt;
}

}  // namespace fast_edi
