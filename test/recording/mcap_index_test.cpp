#include "recording/mcap_index.hpp"

#include <gmock/gmock.h>

#include "recording/mcap_bytes.hpp"

namespace fast_edi {
namespace {

using testing::append;
using testing::appendBytes;
using testing::Bytes;
using ::testing::HasSubstr;
using testing::mcapChannel;
using testing::mcapChunk;
using testing::mcapMessage;
using testing::mcapRecord;

/// Files without the first bytes, which are not the index's concern.
class McapIndexOf : public ::testing::Test {
 protected:
  void put(std::uint8_t kind, const Bytes& content) {
    appendBytes(file_, mcapRecord(kind, content));
  }
  void putChunk(std::uint64_t begin_ns, const Bytes& records) {
    put(kMcapChunk, mcapChunk(begin_ns, "", records.size(), 0, records));
  }
  void putStatistics(std::uint64_t messages, std::uint32_t chunks) {
    Bytes content;
    append(content, messages);
    appendBytes(content, Bytes(14, 0));
    append(content, chunks);
    put(kMcapStatistics, content);
  }
  McapIndex read() {
    const MemorySource source(file_.data(), file_.size());
    McapChunkReader chunks(source);
    return readMcapIndex(source, 0, chunks, topics_);
  }

  Bytes file_;
  McapTopics topics_;
};

TEST_F(McapIndexOf, AWholeFileHasItsPartsByTime) {
  putChunk(30, {});
  put(kMcapMessage, mcapMessage(1, 20));
  putChunk(10, mcapRecord(kMcapChannel, mcapChannel(1, 1, "/in_a_chunk")));
  putStatistics(7, 2);
  put(kMcapFooter, {});
  const McapIndex index = read();
  ASSERT_EQ(index.parts.size(), 3U);
  EXPECT_EQ(index.parts[0].begin_ns, 10U);
  EXPECT_TRUE(index.parts[0].is_chunk);
  EXPECT_EQ(index.parts[1].begin_ns, 20U);
  EXPECT_FALSE(index.parts[1].is_chunk);
  EXPECT_EQ(index.parts[2].begin_ns, 30U);
  EXPECT_EQ(index.parts[2].record.content, kMcapRecordHeaderBytes);
  EXPECT_EQ(index.expected_messages, std::uint64_t{7});
  EXPECT_TRUE(index.damage.empty());
  EXPECT_TRUE(topics_.topics().empty()) << "chunks of a whole file need not be opened";
}

TEST_F(McapIndexOf, AFileWithoutEndHasTheTopicsOfItsChunks) {
  putChunk(10, mcapRecord(kMcapChannel, mcapChannel(1, 1, "/in_a_chunk")));
  const McapIndex index = read();
  ASSERT_EQ(topics_.topics().size(), 1U);
  EXPECT_EQ(topics_.topics()[0].name, "/in_a_chunk");
  ASSERT_EQ(index.damage.size(), 1U);
  EXPECT_EQ(index.damage[0].offset, file_.size());
  EXPECT_THAT(index.damage[0].what, HasSubstr("interrupted"));
}

TEST_F(McapIndexOf, ADamagedFileGoesOnAtTheNextChunk) {
  putChunk(10, {});
  const std::size_t damaged = file_.size();
  appendBytes(file_, Bytes(50, 0));
  const std::size_t next = file_.size();
  putChunk(20, {});
  putStatistics(0, 3);
  put(kMcapFooter, {});
  const McapIndex index = read();
  ASSERT_EQ(index.parts.size(), 2U);
  EXPECT_EQ(index.parts[1].record.content, next + kMcapRecordHeaderBytes);
  ASSERT_EQ(index.damage.size(), 2U);
  EXPECT_EQ(index.damage[0].offset, damaged);
  EXPECT_EQ(index.damage[1].what, "2 chunks are found, expected 3");
}

TEST_F(McapIndexOf, PartsThatAreTooSmallAreLeftOut) {
  put(kMcapMessage, Bytes(kMcapMessageHeaderBytes - 1, 0));
  put(kMcapChunk, Bytes(kMcapChunkHeaderBytes - 1, 0));
  put(kMcapFooter, {});
  const McapIndex index = read();
  EXPECT_TRUE(index.parts.empty());
  ASSERT_EQ(index.damage.size(), 2U);
  EXPECT_EQ(index.damage[0].what, "a message of 21 bytes, expected at least 22 bytes");
  EXPECT_EQ(index.damage[1].what, "the header of a chunk of 39 bytes is damaged");
}

}  // namespace
}  // namespace fast_edi
