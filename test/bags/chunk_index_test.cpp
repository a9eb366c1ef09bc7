#include "bags/chunk_index.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/bags/bag_record.hpp"

namespace fast_edi {
namespace {

MemorySource sourceOf(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

std::uint32_t numberAt(const std::string& bytes, std::size_t offset) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + offset, sizeof(number));
  return number;
}

class ChunkIndexTest : public ::testing::Test {
 protected:
  ChunkIndexTest() {
    index_.add(5, {20, 1}, 0);
    index_.add(2, {10, 2}, 100);
    index_.add(5, {30, 3}, 200);
  }

  ChunkIndex index_;
  std::vector<std::uint8_t> scratch_;
};

TEST_F(ChunkIndexTest, HasARecordOfEachConnection) {
  std::string bytes;
  index_.appendRecords(bytes);
  const MemorySource source = sourceOf(bytes);
  std::map<std::uint32_t, std::string> entries;
  for (std::uint64_t at = 0; at < bytes.size();) {
    const std::optional<Record> record = readRecord(source, at, scratch_);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->kind, RecordKind::kIndex);
    EXPECT_EQ(record->header.number<std::uint32_t>("ver"), 1u);
    const auto data = bytes.substr(record->data_offset, record->data_size);
    EXPECT_EQ(record->header.number<std::uint32_t>("count"), data.size() / 12);
    entries[*record->header.number<std::uint32_t>("conn")] = data;
    at = record->end();
  }
  ASSERT_EQ(entries.size(), 2u);
  ASSERT_EQ(entries[2].size(), 12u);
  EXPECT_EQ(numberAt(entries[2], 0), 10u);
  EXPECT_EQ(numberAt(entries[2], 4), 2u);
  EXPECT_EQ(numberAt(entries[2], 8), 100u);
  ASSERT_EQ(entries[5].size(), 24u);
  EXPECT_EQ(numberAt(entries[5], 12), 30u);
  EXPECT_EQ(numberAt(entries[5], 20), 200u);
}

TEST_F(ChunkIndexTest, SaysWhereTheChunkIsAndWhatIsInIt) {
  std::string bytes;
  index_.appendChunkInfo(bytes, 4711);
  const std::optional<Record> record = readRecord(sourceOf(bytes), 0, scratch_);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->kind, RecordKind::kChunkInfo);
  EXPECT_EQ(record->header.number<std::uint64_t>("chunk_pos"), 4711u);
  EXPECT_EQ(record->header.number<std::uint64_t>("start_time"), std::uint64_t{2} << 32 | 10);
  EXPECT_EQ(record->header.number<std::uint64_t>("end_time"), std::uint64_t{3} << 32 | 30);
  EXPECT_EQ(record->header.number<std::uint32_t>("count"), 2u);
  const std::string counts = bytes.substr(record->data_offset, record->data_size);
  ASSERT_EQ(counts.size(), 16u);
  EXPECT_EQ(numberAt(counts, 0), 2u);
  EXPECT_EQ(numberAt(counts, 4), 1u);
  EXPECT_EQ(numberAt(counts, 8), 5u);
  EXPECT_EQ(numberAt(counts, 12), 2u);
}

}  // namespace
}  // namespace fast_edi
