/// \file
/// A file of parameters that is written as a whole.
#pragma once

#include <string>

namespace fast_edi {

/// Gets its name when it is complete; until then, and for what a crash leaves of it, it is
/// `PATH.active`.
class ParameterFile {
 public:
  /// Makes sure that the file can be written, before any work is done.
  /// An existing file will be replaced.
  /// \throws std::runtime_error naming the file and the reason
  explicit ParameterFile(const std::string& path);
  /// Leaves nothing unless write() was called.
  ~ParameterFile();
  ParameterFile(const ParameterFile&) = delete;
  ParameterFile& operator=(const ParameterFile&) = delete;

  /// \throws std::runtime_error naming the file and the reason
  void write(const std::string& text);

 private:
  const std::string path_;
  const std::string active_path_;
};

}  // namespace fast_edi
