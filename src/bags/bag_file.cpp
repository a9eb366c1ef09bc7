#include "bags/bag_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "bags/record_bytes.hpp"
#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {
namespace {

constexpr std::string_view kFirstLine = "#ROSBAG V2.0\n";
/// Header and data of the file's first record: filled up, since it is written again at the end.
constexpr std::size_t kFileHeaderBytes = 4096;
constexpr std::size_t kCopyBlockBytes = std::size_t{1} << 20;
constexpr mode_t kBagMode = 0666;

[[noreturn]] void throwSystemError() {
  throw BagError(std::strerror(errno));
}

std::string firstRecord(std::uint64_t index_position, std::uint32_t connections,
                        std::uint32_t chunks) {
  const HeaderBytes header = HeaderBytes(RecordKind::kFileHeader)
                                 .add("index_pos", index_position)
                                 .add("conn_count", connections)
                                 .add("chunk_count", chunks);
  std::string bytes;
  appendRecord(bytes, header, std::string(kFileHeaderBytes - header.bytes().size(), ' '));
  return bytes;
}

}  // namespace

BagFile::BagFile(const std::string& path)
    : descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kBagMode)) {
  if (descriptor_ < 0) {
    throwSystemError();
  }
  try {
    write(kFirstLine);
    write(firstRecord(0, 0, 0));
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

BagFile::~BagFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

void BagFile::writeChunk(const std::string& compression, std::uint32_t full_size,
                         std::string_view data, const ChunkIndex& index) {
  const std::uint64_t position = size_;
  writeChunkHead(compression, full_size, static_cast<std::uint32_t>(data.size()));
  write(data);
  endChunk(position, index);
}

void BagFile::copyChunk(const ByteSource& source, const BagChunk& chunk, const ChunkIndex& index) {
  const std::uint64_t position = size_;
  writeChunkHead(chunk.compression, chunk.full_size, static_cast<std::uint32_t>(chunk.size));
  std::vector<std::uint8_t> block;
  for (std::uint64_t done = 0; done < chunk.size; done += kCopyBlockBytes) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(kCopyBlockBytes, chunk.size - done));
    const std::uint8_t* bytes = source.read(chunk.offset + done, count, block);
    if (bytes == nullptr) {
      throw BagError("the input cannot be read again at byte " +
                     std::to_string(chunk.offset + done));
    }
    write({reinterpret_cast<const char*>(bytes), count});
  }
  endChunk(position, index);
}

void BagFile::close(const std::map<std::uint32_t, BagConnection>& connections) {
  const std::uint64_t index_position = size_;
  std::string bytes;
  for (const auto& entry : connections) {
    appendConnection(bytes, entry.second);
  }
  write(bytes);
  write(chunk_infos_);
  if (::lseek(descriptor_, kFirstLine.size(), SEEK_SET) < 0) {
    throwSystemError();
  }
  write(firstRecord(index_position, static_cast<std::uint32_t>(connections.size()), chunks_));
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    throwSystemError();
  }
}

void BagFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      throwSystemError();
    }
    size_ += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void BagFile::writeChunkHead(const std::string& compression, std::uint32_t full_size,
                             std::uint32_t size) {
  std::string head;
  appendRecordHead(
      head, HeaderBytes(RecordKind::kChunk).add("compression", compression).add("size", full_size),
      size);
  write(head);
}

void BagFile::endChunk(std::uint64_t position, const ChunkIndex& index) {
  std::string records;
  index.appendRecords(records);
  write(records);
  index.appendChunkInfo(chunk_infos_, position);
  ++chunks_;
}

void appendConnection(std::string& bytes, const BagConnection& connection) {
  HeaderBytes description;
  for (const auto& [name, value] : *connection.header) {
    description.add(name, std::string_view(value));
  }
  appendRecord(bytes,
               HeaderBytes(RecordKind::kConnection)
                   .add("topic", std::string_view(connection.topic))
                   .add("conn", connection.id),
               description.bytes());
}

}  // namespace fast_edi
