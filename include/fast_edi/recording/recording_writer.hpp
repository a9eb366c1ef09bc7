/// \file
#pragma once

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// Writes a recording that appears under its name only when it is complete.
class RecordingWriter {
 public:
  RecordingWriter() = default;
  virtual ~RecordingWriter() = default;
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  /// \param item its stream is an index into the streams that the writer was made for
  /// \throws RecordingError when it cannot be written
  virtual void write(const RecordingItem& item) = 0;
  /// Completes the output and gives it its name.
  /// \throws RecordingError
  virtual void close() = 0;
};

}  // namespace fast_edi
