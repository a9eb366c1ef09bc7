/// \file
/// Writes HDF5 in the layouts that others read; see hdf5_reader.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/recording_writer.hpp"

namespace fast_edi {

enum class Hdf5Compression { kNone, kGzip };

/// Events as DSEC has them: `events/x`, `y`, `t` [us since `t_offset`] and `p`, with `ms_to_idx`.
/// Frames as event_utils has them: `images/image000000000`, ... with `timestamp` [s], and
/// `exposure_start` and `exposure_end` [s] where they are known.
///
/// Times are rounded down to whole microseconds. IMU samples, triggers and calibration are left
/// out.
class Hdf5Writer : public RecordingWriter {
 public:
  /// Writes to PATH.active, renamed to PATH by close().
  /// \param streams of one camera: events, frames, or both, once each
  /// \param overwrite replace \p path and PATH.active if they exist
  /// \throws RecordingError when \p path cannot or may not be written, or there are several cameras
  Hdf5Writer(const std::string& path, const std::vector<RecordedStream>& streams,
             Hdf5Compression compression, bool overwrite);
  /// Leaves PATH.active behind when close() was not reached.
  ~Hdf5Writer() override;

  /// \throws RecordingError also for a frame whose encoding has neither one nor three channels
  void write(const RecordingItem& item) override;
  void close() override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
