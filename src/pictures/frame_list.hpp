/// \file
/// Which pictures a folder holds, and when they were taken.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

struct ListedFrame {
  std::string path;
  std::optional<ExposureInterval> exposure;
  std::int64_t stamp_ns = 0;  ///< the middle of the exposure where that is known
};

struct FrameList {
  std::vector<ListedFrame> frames;      ///< in the order of their times
  std::vector<RecordingDamage> damage;  ///< lines that cannot be read
};

/// Whether \p folder has one of the lists that readFrameList() reads.
bool hasFrameList(const std::string& folder);

/// One of
/// - frames.csv or images.csv, with the names of its columns in the first line: a file, and a stamp
///   or start and end of the exposure, or all three;
/// - images.txt: a time and a file in each line (IJRR);
/// - Exposure_start.txt and Exposure_end.txt, a time in each line, of the pictures in Blur/ in the
///   order of their names (EVDI).
///
/// The unit of time is the one in the name of the column ("stamp_ns"), else that in which
/// frames come 2 ms to 2 s apart.
/// \throws RecordingError when there is no list, no frame in it, or no unit of time
FrameList readFrameList(const std::string& folder);

}  // namespace fast_edi
