/// \file
/// Opens recordings; their format is recognised by content, not by file name.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

enum class RecordingFormat { kUnknown, kRosbag, kAedat4, kAedat2, kAedat3, kRosbag2, kHdf5, kZip };

/// By the first bytes of the file; a folder by the files in it.
/// \throws RecordingError when \p path cannot be read
RecordingFormat formatOf(const std::string& path);

/// The reader for a recording; null when its format is not known, or its reader needs further
/// libraries: rosbag needs ROS (see openMessages()), HDF5 and zip archives need
/// theirs (see openRecordingOrPictures()).
/// \throws RecordingError when the file cannot be read at all
std::unique_ptr<Recording> openRecording(const std::string& path);

}  // namespace fast_edi
