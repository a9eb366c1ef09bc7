#include "fast_edi/recording/byte_source.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {

FileSource::FileSource(const std::string& path) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw RecordingError("cannot open " + path + ": " + std::strerror(errno));
  }
  struct stat status = {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw RecordingError("cannot read " + path + ": not a regular file");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileSource::~FileSource() {
  ::close(descriptor_);
}

const std::uint8_t* FileSource::read(std::uint64_t offset, std::size_t count,
                                     std::vector<std::uint8_t>& scratch) const {
  if (offset > size_ || count > size_ - offset) {
    return nullptr;
  }
  if (scratch.size() < count) {
    scratch.resize(count);
  }
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor_, scratch.data() + done, count - done,
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return nullptr;
    }
    done += static_cast<std::size_t>(got);
  }
  return scratch.data();
}

const std::uint8_t* MemorySource::read(std::uint64_t offset, std::size_t count,
                                       std::vector<std::uint8_t>&) const {
  if (offset > size_ || count > size_ - offset) {
    return nullptr;
  }
  return data_ + offset;
}

}  // namespace fast_edi
