#include "recording/mcap_chunk_reader.hpp"

#include <gmock/gmock.h>

#include <string>

#include "recording/mcap_bytes.hpp"

namespace fast_edi {
namespace {

using testing::Bytes;
using ::testing::HasSubstr;
using testing::mcapChunk;

const Bytes kRecords = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
constexpr std::uint32_t kChecksum = 0xCBF43926;  ///< of the records: the check value of CRC-32

RawBytes raw(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

/// What is wrong with a chunk.
std::string fault(const Bytes& chunk, RawBytes& records) {
  const MemorySource file(chunk.data(), chunk.size());
  McapChunkReader reader(file);
  return reader.read({kMcapChunk, 0, chunk.size()}, records);
}

TEST(McapChunkReader, DecompressesAndChecks) {
  RawBytes records;
  for (const char* name : {"", "lz4", "zstd"}) {
    Bytes stored = kRecords;
    if (*name != '\0') {
      compress(*mcapCompression(name), kRecords.data(), kRecords.size(), stored);
    }
    EXPECT_EQ(fault(mcapChunk(0, name, kRecords.size(), kChecksum, stored), records), "") << name;
    EXPECT_EQ(records, raw(kRecords)) << name;
  }
  EXPECT_EQ(fault(mcapChunk(0, "", kRecords.size(), 0, kRecords), records), "") << "no checksum";
}

TEST(McapChunkReader, SaysWhatIsWrongAndGivesWhatIsThere) {
  RawBytes records;
  EXPECT_THAT(fault(mcapChunk(0, "", kRecords.size(), kChecksum + 1, kRecords), records),
              HasSubstr("checksum"));
  EXPECT_EQ(records, raw(kRecords));
  EXPECT_EQ(fault(mcapChunk(0, "", 10, kChecksum, kRecords), records),
            "a chunk of 9 bytes, expected 10 bytes");
  EXPECT_EQ(records, raw(kRecords));
}

TEST(McapChunkReader, GivesNothingOfAChunkThatItCannotRead) {
  RawBytes records = raw(kRecords);
  EXPECT_THAT(fault(mcapChunk(0, "bz2", kRecords.size(), 0, kRecords), records),
              HasSubstr("\"bz2\", expected none, lz4 or zstd"));
  EXPECT_TRUE(records.empty());
  records = raw(kRecords);
  EXPECT_EQ(fault(Bytes(30, 0), records), "the header of a chunk is damaged");
  EXPECT_TRUE(records.empty());
  const MemorySource file(kRecords.data(), kRecords.size());
  EXPECT_EQ(McapChunkReader(file).read({kMcapChunk, 4, 100}, records), "cannot be read");
}

}  // namespace
}  // namespace fast_edi
