#include "recording/davis_geometry.hpp"

#include <cctype>

#include "fast_edi/recording/recording_error.hpp"

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

std::vector<RecordedStream> davisStreams(const std::string& path, const std::string& name,
                                         const std::string& line) {
  const std::optional<SensorSize> size = davisSize(name);
  if (!size) {
    throw RecordingError(
        path + ": recorded by " +
        (name.empty() ? "a camera that no line \"" + line + "\" names" : "\"" + name + "\"") +
        ", expected a DAVIS240 or DAVIS346");
  }
  return {{StreamKind::kEvents, "events", name, *size},
          {StreamKind::kFrames, "frames", name, *size},
          {StreamKind::kImu, "imu", name, {}}};
}

}  // namespace fast_edi
