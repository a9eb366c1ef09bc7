/// \file
/// AEDAT2, the format of jAER
/// (https://docs.inivation.com/software/software-advanced-usage/file-formats/aedat-2.0.html), of
/// DAVIS cameras.
///
/// Lines that begin with `#`, then big-endian records {u32 address, u32 time [us]}. A record is an
/// event, or one read of a pixel (reset or signal), or one number of the IMU. Columns of events are
/// counted from the right and rows from below, as jAER has them.
///
/// A frame is assembled of a reset and a signal read of each pixel: the level that light has taken
/// away, reset minus signal, in 10 bits, given as mono16 shifted up by 6. Its exposure lasts from
/// the last reset read to the first signal read (global shutter); where signal reads begin before
/// resets have ended (rolling shutter), from the first reset read to the first signal read, which
/// is that of the first column.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// \throws RecordingError when the file cannot be opened, or was recorded by a camera that is no
///         DAVIS240 or DAVIS346
std::unique_ptr<Recording> openAedat2(const std::string& path);

}  // namespace fast_edi
