#include "recording/file_decompression.hpp"

#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

/// Read at once [bytes].
constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
/// A decompressed file is no larger than this, plus this many times the compressed one.
constexpr std::uint64_t kFreeBytes = std::uint64_t{64} << 20;
constexpr std::uint64_t kMaxGrowth = 256;

/// A file without a name.
class NamelessFile {
 public:
  NamelessFile() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "fast_edi_recording_XXXXXX").string();
    descriptor_ = ::mkstemp(pattern.data());
    if (descriptor_ < 0) {
      throw RecordingError("cannot make a temporary file like " + pattern + ": " +
                           std::strerror(errno));
    }
    ::unlink(pattern.c_str());
  }
  ~NamelessFile() { ::close(descriptor_); }
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  void write(const std::uint8_t* data, std::size_t size) const {
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, data, size);
      if (written < 0 && errno == EINTR) {
        continue;
      }
      if (written <= 0) {
        throw RecordingError("cannot write what a compressed recording holds into " +
                             std::filesystem::temp_directory_path().string() + ": " +
                             std::strerror(errno) + "; TMPDIR names another folder");
      }
      data += written;
      size -= static_cast<std::size_t>(written);
    }
  }
  std::unique_ptr<ByteSource> source() const {
    return std::make_unique<FileSource>("/proc/self/fd/" + std::to_string(descriptor_));
  }

 private:
  int descriptor_ = -1;
};

struct FreeContext {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

bool beginsWithZstd(const std::uint8_t* data, std::size_t size) {
  return size >= sizeof(kZstdMagic) &&
         std::equal(std::begin(kZstdMagic), std::end(kZstdMagic), data);
}

std::unique_ptr<ByteSource> decompressFile(const ByteSource& file, std::string& fault) {
  const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  if (!context) {
    throw std::bad_alloc();
  }
  const NamelessFile output;
  const std::uint64_t limit = kFreeBytes + kMaxGrowth * file.size();
  std::vector<std::uint8_t> scratch;
  std::vector<std::uint8_t> block(ZSTD_DStreamOutSize());
  std::uint64_t written = 0;
  std::size_t wanted = 0;  // 0: a frame has ended
  fault.clear();
  for (std::uint64_t offset = 0; offset < file.size() && fault.empty();) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(kBlockBytes, file.size() - offset));
    const std::uint8_t* bytes = file.read(offset, count, scratch);
    if (bytes == nullptr) {
      fault = "cannot be read";
      break;
    }
    ZSTD_inBuffer input{bytes, count, 0};
    ZSTD_outBuffer room{block.data(), block.size(), 0};
    do {
      room.pos = 0;
      wanted = ZSTD_decompressStream(context.get(), &room, &input);
      if (ZSTD_isError(wanted) != 0) {
        fault = std::string("ZSTD: ") + ZSTD_getErrorName(wanted) + " at byte " +
                std::to_string(offset + input.pos);
        break;
      }
      written += room.pos;
      if (written > limit) {
        fault = "larger than " + std::to_string(limit) + " bytes when decompressed";
        break;
      }
      output.write(block.data(), room.pos);
    } while (input.pos < input.size || room.pos == room.size);
    offset += count;
  }
  if (fault.empty() && wanted != 0) {
    fault = "ZSTD frame is cut";
  }
  return output.source();
}

}  // namespace fast_edi
