#include "fast_edi/bags/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {
namespace {

/// Whether the open file is still the one of that name.
bool isNamed(int descriptor, const std::string& path) {
  struct stat open = {};
  struct stat named = {};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

}  // namespace

bool FileLock::take(const std::string& path) {
  release();
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) {
    throw BagError("cannot open " + path + ": " + std::strerror(errno));
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int cause = errno;
    ::close(descriptor);
    if (cause == EWOULDBLOCK) {
      return false;
    }
    throw BagError("cannot lock " + path + ": " + std::strerror(cause));
  }
  if (!isNamed(descriptor, path)) {
    ::close(descriptor);
    return false;
  }
  descriptor_ = descriptor;
  return true;
}

void FileLock::release() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

}  // namespace fast_edi
