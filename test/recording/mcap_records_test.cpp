#include "recording/mcap_records.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "recording/mcap_bytes.hpp"

namespace fast_edi {
namespace {

using testing::append;
using testing::appendBytes;
using testing::appendText;
using testing::Bytes;
using testing::mcapChunk;

constexpr std::uint64_t kHuge = std::numeric_limits<std::uint64_t>::max();

/// A message of five bytes that states another size.
Bytes recordOf(std::uint8_t kind, std::uint64_t stated) {
  Bytes bytes = {kind};
  append(bytes, stated);
  appendBytes(bytes, Bytes(5, 0));
  return bytes;
}

bool isRecordOfFile(const Bytes& bytes, std::uint64_t offset = 0) {
  const MemorySource file(bytes.data(), bytes.size());
  std::vector<std::uint8_t> scratch;
  return mcapRecordAt(file, offset, scratch).has_value();
}

RawBytes raw(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

TEST(McapFields, AreEmptyFromTheFirstThatIsCut) {
  Bytes bytes;
  append(bytes, std::uint16_t{7});
  appendText(bytes, "ab");
  append(bytes, std::numeric_limits<std::uint32_t>::max());  // the length of a text
  append(bytes, std::uint64_t{1});
  McapFields fields(bytes.data(), bytes.size());
  EXPECT_EQ(fields.number<std::uint16_t>(), 7);
  EXPECT_EQ(fields.text(), "ab");
  EXPECT_TRUE(fields.ok());
  EXPECT_EQ(fields.place(), 8U);
  EXPECT_EQ(fields.text(), "");
  EXPECT_FALSE(fields.ok());
  EXPECT_EQ(fields.number<std::uint8_t>(), 0);
  EXPECT_FALSE(fields.ok());
}

TEST(McapRecord, OfAChunkEndsWithinIt) {
  const Bytes bytes = recordOf(kMcapMessage, 5);
  const std::optional<McapRecord> record = mcapRecordAt(raw(bytes), 0);
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->kind, kMcapMessage);
  EXPECT_EQ(record->content, kMcapRecordHeaderBytes);
  EXPECT_EQ(record->size, 5U);
  EXPECT_EQ(record->end(), bytes.size());
  EXPECT_FALSE(mcapRecordAt(raw(bytes), bytes.size()).has_value());
  EXPECT_FALSE(mcapRecordAt(raw(bytes), bytes.size() - kMcapRecordHeaderBytes + 1).has_value());
  for (const std::uint64_t stated : {std::uint64_t{6}, kHuge / 2, kHuge - 8, kHuge}) {
    EXPECT_FALSE(mcapRecordAt(raw(recordOf(kMcapMessage, stated)), 0).has_value()) << stated;
  }
}

TEST(McapRecord, OfAFileEndsWithinItAndHasAKnownKind) {
  for (const std::uint8_t kind : {kMcapHeader, kMcapDataEnd, kMcapFirstPrivate}) {
    EXPECT_TRUE(isRecordOfFile(recordOf(kind, 5))) << int{kind};
  }
  for (const std::uint8_t kind : {std::uint8_t{0x00}, std::uint8_t{0x10}, std::uint8_t{0x7f}}) {
    EXPECT_FALSE(isRecordOfFile(recordOf(kind, 5))) << int{kind};
  }
  for (const std::uint64_t stated : {std::uint64_t{6}, kHuge / 2, kHuge - 8, kHuge}) {
    EXPECT_FALSE(isRecordOfFile(recordOf(kMcapMessage, stated))) << stated;
  }
  for (const std::uint64_t offset : {std::uint64_t{6}, std::uint64_t{14}, kHuge - 4}) {
    EXPECT_FALSE(isRecordOfFile(recordOf(kMcapMessage, 5), offset)) << offset;
  }
}

TEST(McapChunkHeader, AgreesWithTheSizeOfTheChunk) {
  const Bytes chunk = mcapChunk(3, "zstd", 100, 9, Bytes(20, 0));
  const std::optional<McapChunkHeader> header =
      mcapChunkHeader(chunk.data(), chunk.size(), chunk.size());
  ASSERT_TRUE(header.has_value());
  EXPECT_EQ(header->begin_ns, 3U);
  EXPECT_EQ(header->records_bytes, 100U);
  EXPECT_EQ(header->checksum, 9U);
  EXPECT_EQ(header->compression, "zstd");
  EXPECT_EQ(header->header_bytes, kMcapChunkHeaderBytes + 4);
  for (std::size_t there = 0; there < header->header_bytes; ++there) {
    EXPECT_FALSE(mcapChunkHeader(chunk.data(), there, chunk.size()).has_value()) << there;
  }
  for (const std::uint64_t size : {std::uint64_t{0}, std::uint64_t{chunk.size() - 1}, kHuge}) {
    EXPECT_FALSE(mcapChunkHeader(chunk.data(), chunk.size(), size).has_value()) << size;
  }
  const Bytes long_name = mcapChunk(3, std::string(kMaxMcapCompressionName + 1, 'x'), 0, 0, {});
  EXPECT_FALSE(mcapChunkHeader(long_name.data(), long_name.size(), long_name.size()).has_value());
}

TEST(McapCompression, IsKnownByItsName) {
  EXPECT_EQ(mcapCompression(""), Compression::kNone);
  EXPECT_EQ(mcapCompression("lz4"), Compression::kLz4);
  EXPECT_EQ(mcapCompression("zstd"), Compression::kZstd);
  EXPECT_EQ(mcapCompression("LZ4"), std::nullopt);
}

}  // namespace
}  // namespace fast_edi
