#include "bags/copied_chunks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/bags/bag_record.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

BagChunk chunkOf(std::uint64_t offset, std::uint32_t last_second) {
  BagChunk chunk;
  chunk.offset = offset;
  chunk.last_time = std::uint64_t{last_second} << 32;
  return chunk;
}

class CopiedChunksTest : public ::testing::Test {
 protected:
  void add(const BagChunk& chunk, std::uint32_t second) {
    BagMessage message;
    message.connection = &connection_;
    message.time = {second, 0};
    message.chunk = &chunk;
    message.place = second;
    chunks_.add(message, write_);
  }

  BagConnection connection_;
  CopiedChunks chunks_;
  std::vector<std::uint64_t> written_;
  std::vector<std::uint32_t> counts_;
  const CopiedChunks::Write write_ = [this](const BagChunk& chunk, const ChunkIndex& index) {
    written_.push_back(chunk.offset);
    std::string bytes;
    index.appendRecords(bytes);
    const MemorySource source(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    std::vector<std::uint8_t> scratch;
    counts_.push_back(*readRecord(source, 0, scratch)->header.number<std::uint32_t>("count"));
  };
};

TEST_F(CopiedChunksTest, AreWrittenWhenTheirTimeIsOver) {
  const BagChunk first = chunkOf(100, 2);
  const BagChunk second = chunkOf(200, 4);
  add(first, 1);
  add(first, 2);
  add(first, 2);  // of the same time
  EXPECT_THAT(written_, IsEmpty());
  add(second, 2);
  EXPECT_THAT(written_, ElementsAre(100));
  add(second, 4);
  chunks_.finish(write_);
  EXPECT_THAT(written_, ElementsAre(100, 200));
  EXPECT_THAT(counts_, ElementsAre(3, 2));
}

TEST_F(CopiedChunksTest, ThatOverlapKeepTheOrderOfTheFile) {
  const BagChunk long_one = chunkOf(100, 9);
  const BagChunk short_one = chunkOf(200, 2);
  add(short_one, 1);
  add(long_one, 1);
  add(short_one, 2);
  add(long_one, 5);
  EXPECT_THAT(written_, IsEmpty());
  chunks_.finish(write_);
  EXPECT_THAT(written_, ElementsAre(100, 200));
}

TEST_F(CopiedChunksTest, DoNotWaitForThoseBehindThem) {
  const BagChunk early = chunkOf(200, 2);
  const BagChunk late = chunkOf(100, 9);
  add(early, 1);
  add(early, 2);
  add(late, 3);
  EXPECT_THAT(written_, ElementsAre(200));
}

TEST_F(CopiedChunksTest, EndBeforeATime) {
  const BagChunk first = chunkOf(100, 2);
  const BagChunk second = chunkOf(200, 4);
  add(first, 1);
  add(second, 1);
  chunks_.endBefore(first.last_time, 50, write_);
  EXPECT_THAT(written_, IsEmpty());
  chunks_.endBefore(first.last_time, 150, write_);
  EXPECT_THAT(written_, ElementsAre(100));
  chunks_.endBefore(second.last_time + 1, 50, write_);
  EXPECT_THAT(written_, ElementsAre(100, 200));
}

TEST_F(CopiedChunksTest, HaveNoMoreThanWhatCame) {
  const BagChunk chunk = chunkOf(100, 9);
  add(chunk, 1);
  chunks_.finish(write_);
  EXPECT_THAT(counts_, ElementsAre(1));
  chunks_.finish(write_);
  EXPECT_THAT(written_, ElementsAre(100));
}

}  // namespace
}  // namespace fast_edi
