/// \file
/// Writes AEDAT4, which iniVation's DV and dv-processing read; see aedat4_reader.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/recording_writer.hpp"

namespace fast_edi {

enum class Aedat4Compression { kNone = 0, kLz4 = 1, kZstd = 3 };

/// Times are rounded down to whole microseconds, which is all that the format has. Calibration is
/// left out: the format has no place for it. A frame whose exposure is not known is written with
/// start and end at its stamp.
class Aedat4Writer : public RecordingWriter {
 public:
  /// Events of one packet, as dv-processing writes them.
  static constexpr std::size_t kPacketEvents = 10'000;

  /// Writes to PATH.active, renamed to PATH by close().
  /// \param overwrite replace \p path and PATH.active if they exist
  /// \throws RecordingError when \p path cannot or may not be written
  Aedat4Writer(const std::string& path, const std::vector<RecordedStream>& streams,
               Aedat4Compression compression, bool overwrite);
  /// Leaves PATH.active behind when close() was not reached.
  ~Aedat4Writer() override;

  /// \throws RecordingError also for a frame whose encoding the format does not have
  void write(const RecordingItem& item) override;
  void close() override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
