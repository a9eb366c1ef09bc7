/// \file
/// Output that appears under its name only when it is complete.
#pragma once

#include <string>

namespace fast_edi {

class OutputPath {
 public:
  /// \param overwrite replace \p path and PATH.active if they exist
  /// \throws RecordingError when one of both may not be written
  OutputPath(const std::string& path, bool overwrite);

  /// PATH.active, where it is to be written.
  const std::string& active() const { return active_; }
  /// Gives it its name.
  /// \throws RecordingError
  void complete() const;

 private:
  const std::string path_;
  const std::string active_;
};

}  // namespace fast_edi
