/// \file
/// A folder or a zip archive of pictures and text as a recording: IJRR, EVDI, frames.csv and
/// events.csv. What is found out of the columns, units and coordinates: see frame_list.hpp and
/// event_text.hpp.
///
/// Events are read as a stream, pictures one by one; only the list of frames is kept.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// \throws RecordingError when there are no frames, or their times or the events' columns are not
///         clear
std::unique_ptr<Recording> openPictureFolder(const std::string& path);

/// The same in an archive; nothing is unpacked to the disk.
/// \throws RecordingError as above, and when \p path is no archive
std::unique_ptr<Recording> openPictureArchive(const std::string& path);

}  // namespace fast_edi
