/// \file
/// Which pictures a folder or archive holds, and when they were taken.
#pragma once

#include <string>
#include <vector>

#include "fast_edi/recording/recording.hpp"
#include "recording/file_set.hpp"
#include "recording/merged_recording.hpp"

namespace fast_edi {

struct ListedFrame {
  std::string name;  ///< among the files
  FrameTime time;
};

struct FrameList {
  std::vector<ListedFrame> frames;      ///< in the order of their times
  std::vector<RecordingDamage> damage;  ///< lines that cannot be read
};

/// Whether \p files have one of the lists that readFrameList() reads.
bool hasFrameList(const FileSet& files);

/// One of
/// - frames.csv or images.csv, with the names of its columns in the first line: a file, and a stamp
///   or start and end of the exposure, or all three;
/// - images.txt: a time and a file in each line (IJRR);
/// - Exposure_start.txt and Exposure_end.txt, a time in each line, of the pictures in Blur/ in the
///   order of their names (EVDI).
///
/// The unit of time is the one in the name of the column ("stamp_ns"), else that in which
/// frames come 2 ms to 2 s apart.
/// A list has at most 64 MiB.
/// \throws RecordingError when there is no list, no frame in it, or no unit of time
FrameList readFrameList(const FileSet& files);

}  // namespace fast_edi
