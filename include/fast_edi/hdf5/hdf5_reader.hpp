/// \file
/// HDF5 in the layouts in which recordings of event cameras are shared:
/// - events in the columns `x`, `y`, `t`, `p` (DSEC, TUM-VIE, e2calib) or `xs`, `ys`, `ts`, `ps`
///   (event_utils, HQF) of the group `events` or of the file; or in the rows of one dataset:
///   `events` with t, x, y, p (v2e), `davis/left/events` with x, y, t, p (MVSEC);
/// - frames as `images/image000000000`, ... with the attribute `timestamp`, and `exposure_start`
/// and
///   `exposure_end` where they are known (event_utils, REBlur); or in `davis/left/image_raw` with
///   their times in `davis/left/image_raw_ts` (MVSEC).
///
/// Times that are whole numbers are microseconds, or nanoseconds where only these fit; others are
/// seconds, rounded to whole microseconds. An attribute `unit` or `units` (text of a fixed length)
/// says otherwise. `t_offset` is added to the times of events (DSEC).
///
/// Events are read block by block, frames one by one. HDF5's library trusts what it reads: it runs
/// in a process of its own (see isolated_recording.hpp), and a file is refused whose parts lie in
/// other files, or that would take memory beyond all measure.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// \throws RecordingError when \p path is no HDF5 file, has neither events nor frames in one of the
///         layouts, or needs a filter that is not installed
std::unique_ptr<Recording> openHdf5(const std::string& path);

}  // namespace fast_edi
