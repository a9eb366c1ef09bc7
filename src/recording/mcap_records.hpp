/// \file
/// Records of MCAP (https://mcap.dev/spec): kind (1 byte), size of the content (8 bytes), content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/raw_bytes.hpp"
#include "fast_edi/recording/byte_source.hpp"
#include "recording/packet_compression.hpp"

namespace fast_edi {

constexpr std::size_t kMcapRecordHeaderBytes = 9;

// Kinds of records.
constexpr std::uint8_t kMcapHeader = 0x01;
constexpr std::uint8_t kMcapFooter = 0x02;
constexpr std::uint8_t kMcapSchema = 0x03;
constexpr std::uint8_t kMcapChannel = 0x04;
constexpr std::uint8_t kMcapMessage = 0x05;
constexpr std::uint8_t kMcapChunk = 0x06;
constexpr std::uint8_t kMcapStatistics = 0x0B;
constexpr std::uint8_t kMcapDataEnd = 0x0F;
/// Those from here on are of programs' own.
constexpr std::uint8_t kMcapFirstPrivate = 0x80;

/// Channel, sequence, time of record, time of sending.
constexpr std::size_t kMcapMessageHeaderBytes = 22;
constexpr std::size_t kMcapMessageTime = 6;
/// Two times, size, checksum, length of the compression's name, size of the records.
constexpr std::size_t kMcapChunkHeaderBytes = 40;
constexpr std::size_t kMaxMcapCompressionName = 16;

/// Where a record lies: in the file, or in the records of a chunk.
struct McapRecord {
  std::uint8_t kind = 0;
  std::uint64_t content = 0;  ///< its offset
  std::uint64_t size = 0;     ///< of the content
  std::uint64_t end() const { return content + size; }
};

/// What stands in a chunk before its records.
struct McapChunkHeader {
  std::uint64_t begin_ns = 0;
  std::uint64_t records_bytes = 0;  ///< as stated
  std::uint32_t checksum = 0;       ///< 0: none
  std::string compression;
  std::size_t header_bytes = 0;
};

/// Little-endian numbers and strings, one after the other. After the first that lies beyond the
/// end, ok() is false and all that is read is 0 or empty.
class McapFields {
 public:
  McapFields(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool ok() const { return ok_; }
  std::size_t place() const { return place_; }

  template <typename Number>
  Number number() {
    Number value{};
    if (!ok_ || size_ - place_ < sizeof(value)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, data_ + place_, sizeof(value));
    place_ += sizeof(value);
    return value;
  }
  std::string text();

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t place_ = 0;
  bool ok_ = true;
};

/// The record at \p offset of a file; nothing where no record can be.
std::optional<McapRecord> mcapRecordAt(const ByteSource& file, std::uint64_t offset,
                                       std::vector<std::uint8_t>& scratch);
/// The record at \p place of a chunk's records; nothing when it ends behind them.
/// \pre place <= records.size()
std::optional<McapRecord> mcapRecordAt(const RawBytes& records, std::size_t place);

/// Nothing when it contradicts the size of the chunk.
/// \param data of the chunk, of which \p there bytes can be read
/// \param chunk_bytes size of all of it
std::optional<McapChunkHeader> mcapChunkHeader(const std::uint8_t* data, std::size_t there,
                                               std::uint64_t chunk_bytes);

/// By the name in the header of a chunk; nothing for one that is not known.
std::optional<Compression> mcapCompression(const std::string& name);

/// For messages.
std::string mcapSizeText(std::uint64_t size);

}  // namespace fast_edi
