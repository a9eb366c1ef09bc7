/// \file
/// Recordings of other formats than rosbag as output: AEDAT4 and HDF5, told by the ending of the
/// name (.aedat4; .h5 or .hdf5).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/recording_writer.hpp"

namespace fast_edi::tools {

bool isRecordingOutput(const std::string& path);

/// \throws std::invalid_argument when the format of \p path does not have \p compression
void checkCompression(const std::string& path, const std::string& compression);

/// \param path isRecordingOutput()
/// \param compression empty: the usual one of the format, LZ4 or gzip
/// \throws std::invalid_argument as checkCompression()
/// \throws RecordingError when \p path cannot or may not be written
std::unique_ptr<RecordingWriter> makeRecordingWriter(const std::string& path,
                                                     const std::vector<RecordedStream>& streams,
                                                     const std::string& compression,
                                                     bool overwrite);

}  // namespace fast_edi::tools
