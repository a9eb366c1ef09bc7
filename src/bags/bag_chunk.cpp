#include "fast_edi/bags/bag_chunk.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "bags/chunk_compression.hpp"

namespace fast_edi {
namespace {

/// Room for the output at first, unless the chunk's header says that less will do; doubled when it
/// is full. So a damaged size field takes no more memory than the data call for.
constexpr std::size_t kFirstRoomBytes = 1 << 22;

/// Damaged data are not decompressed further than this. Chunks of rosbag have 768 kB by default.
constexpr std::size_t kMaxUnstatedBytes = std::size_t{1} << 28;

/// libbz2 counts in 32 bits.
constexpr std::size_t kMaxStepBytes = std::size_t{1} << 30;

/// One streaming decompressor: next_in/next_out of both libraries, made alike.
class Bz2 {
 public:
  static std::size_t spareBytes(std::size_t) { return 0; }

  Bz2(const std::uint8_t* data, std::size_t size) {
    stream_.next_in = const_cast<char*>(reinterpret_cast<const char*>(data));
    stream_.avail_in = static_cast<unsigned>(size);
    usable_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK;
  }
  ~Bz2() {
    if (usable_) {
      BZ2_bzDecompressEnd(&stream_);
    }
  }
  Bz2(const Bz2&) = delete;
  Bz2& operator=(const Bz2&) = delete;

  /// Bytes written; \p done is set at the end of the stream and at damage.
  std::size_t decompress(std::uint8_t* output, std::size_t room, bool& done, bool& whole) {
    stream_.next_out = reinterpret_cast<char*>(output);
    stream_.avail_out = static_cast<unsigned>(room);
    const int result = usable_ ? BZ2_bzDecompress(&stream_) : BZ_DATA_ERROR;
    const std::size_t written = room - stream_.avail_out;
    whole = result == BZ_STREAM_END;
    done = result != BZ_OK || written == 0;
    return written;
  }

  bool hasTakenAll() const { return stream_.avail_in == 0; }

 private:
  bz_stream stream_ = {};
  bool usable_ = false;
};

/// liblz4's own frame decoder instead of roslz4's: the latter follows a damaged block length.
class Lz4 {
 public:
  /// liblz4 decodes in place only where there is room for a whole block, which a chunk's only one
  /// does not fill; else it copies, which small chunks do not mind.
  static std::size_t spareBytes(std::size_t size) {
    return size < kBlockBytes / 4 ? 0 : kBlockBytes;
  }

  Lz4(const std::uint8_t* data, std::size_t size) : next_(data), left_(size) {
    usable_ = !LZ4F_isError(LZ4F_createDecompressionContext(&context_, LZ4F_VERSION));
  }
  ~Lz4() { LZ4F_freeDecompressionContext(context_); }
  Lz4(const Lz4&) = delete;
  Lz4& operator=(const Lz4&) = delete;

  std::size_t decompress(std::uint8_t* output, std::size_t room, bool& done, bool& whole) {
    std::size_t written = room;
    // No more than the block it asks for: after an error nothing tells how much was decoded.
    std::size_t taken = std::min(left_, wanted_);
    if (usable_) {
      wanted_ = LZ4F_decompress(context_, output, &written, next_, &taken, nullptr);
    }
    if (!usable_ || LZ4F_isError(wanted_)) {
      done = true;
      return 0;
    }
    next_ += taken;
    left_ -= taken;
    whole = wanted_ == 0;
    done = whole || (written == 0 && taken == 0);
    return written;
  }

  bool hasTakenAll() const { return left_ == 0; }

 private:
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 20;  ///< in rosbag

  LZ4F_dctx* context_ = nullptr;
  const std::uint8_t* next_;
  std::size_t left_;
  std::size_t wanted_ = LZ4F_HEADER_SIZE_MIN;
  bool usable_ = false;
};

template <typename Decompressor>
ChunkBytes run(const std::uint8_t* data, std::size_t size, std::size_t full_size) {
  Decompressor decompressor(data, size);
  // One more than stated, so that the end of the data shows.
  const std::size_t limit = std::max(full_size + 1, kMaxUnstatedBytes);
  std::size_t capacity = full_size > 0 ? std::min(full_size, kFirstRoomBytes) : kFirstRoomBytes;
  capacity += Decompressor::spareBytes(capacity);
  ChunkBytes chunk;
  // Not initialised, as a vector would be: it is written at once.
  chunk.data.reset(new std::uint8_t[capacity]);
  bool done = false;
  bool whole = false;
  while (!done && chunk.size < limit) {
    if (chunk.size == capacity) {
      capacity = std::min(2 * capacity, limit);
      std::unique_ptr<std::uint8_t[]> larger(new std::uint8_t[capacity]);
      std::memcpy(larger.get(), chunk.data.get(), chunk.size);
      chunk.data = std::move(larger);
    }
    chunk.size += decompressor.decompress(
        chunk.data.get() + chunk.size, std::min(capacity - chunk.size, kMaxStepBytes), done, whole);
  }
  chunk.complete = whole && (full_size == 0 || chunk.size == full_size);
  chunk.copyable = chunk.complete && decompressor.hasTakenAll();
  return chunk;
}

}  // namespace

bool isKnownCompression(std::string_view compression) {
  return compression == "none" || compression == "bz2" || compression == "lz4";
}

ChunkBytes decompressChunk(std::string_view compression, const std::uint8_t* data, std::size_t size,
                           std::size_t full_size) {
  if (compression == "bz2") {
    return run<Bz2>(data, size, full_size);
  }
  ChunkBytes chunk = run<Lz4>(data, size, full_size);
  chunk.copyable = chunk.copyable && isRosbagLz4({reinterpret_cast<const char*>(data), size});
  return chunk;
}

}  // namespace fast_edi
