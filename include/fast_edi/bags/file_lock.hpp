/// \file
/// A lock on a file, by which processes that write the same file see each other. The system gives
/// it back when its process ends, however it ends.
#pragma once

#include <string>

namespace fast_edi {

class FileLock {
 public:
  FileLock() = default;
  ~FileLock() { release(); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// \return false when somebody else holds it, or has just replaced the file
  /// \throws BagError when the file cannot be opened or its file system has no locks
  bool take(const std::string& path);
  bool isHeld() const { return descriptor_ >= 0; }
  void release();

 private:
  int descriptor_ = -1;
};

}  // namespace fast_edi
