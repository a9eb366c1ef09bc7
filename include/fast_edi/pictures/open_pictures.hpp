/// \file
/// Recordings that need no ROS, folders of pictures among them.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// The reader for a folder of pictures and text, or what openRecording() gives.
/// \throws RecordingError when it cannot be read at all
std::unique_ptr<Recording> openRecordingOrPictures(const std::string& path);

}  // namespace fast_edi
