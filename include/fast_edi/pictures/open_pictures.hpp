/// \file
/// Recordings that need no ROS: also HDF5, folders of pictures, and the same as zip archives.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// The reader for a folder or archive of pictures and text, for HDF5, or what openRecording()
/// gives. \throws RecordingError when it cannot be read at all
std::unique_ptr<Recording> openRecordingOrPictures(const std::string& path);

}  // namespace fast_edi
