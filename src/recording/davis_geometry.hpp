/// \file
/// What files of jAER and cAER have in common: the camera by its name, and three streams.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

// Index of each stream of davisStreams().
constexpr std::size_t kDavisEvents = 0;
constexpr std::size_t kDavisFrames = 1;
constexpr std::size_t kDavisImu = 2;

/// "eu.seebetter.ini.chips.davis.DAVIS240C", "DAVIS346B", ...; nothing for other cameras.
std::optional<SensorSize> davisSize(const std::string& name);

/// Events, frames and IMU samples of a camera.
/// \param path for messages
/// \param name of the camera, empty when the header has none
/// \param line of the header that names it, for messages
/// \throws RecordingError unless it is a DAVIS240 or DAVIS346
std::vector<RecordedStream> davisStreams(const std::string& path, const std::string& name,
                                         const std::string& line);

}  // namespace fast_edi
