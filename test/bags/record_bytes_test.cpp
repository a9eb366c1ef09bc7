#include "bags/record_bytes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fast_edi {
namespace {

TEST(RecordBytes, AreReadAsTheyWereWritten) {
  std::string bytes = "before";
  appendRecord(bytes,
               HeaderBytes(RecordKind::kChunk)
                   .add("text", std::string_view("a=b"))
                   .add("small", std::uint32_t{7})
                   .add("large", std::uint64_t{1} << 40)
                   .add("time", ros::Time(3, 4)),
               "data");
  appendRecord(bytes, HeaderBytes(RecordKind::kMessage), "");

  const MemorySource source(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  std::vector<std::uint8_t> scratch;
  const std::optional<Record> first = readRecord(source, 6, scratch);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, RecordKind::kChunk);
  EXPECT_EQ(first->header.text("text"), "a=b");
  EXPECT_EQ(first->header.number<std::uint32_t>("small"), 7u);
  EXPECT_EQ(first->header.number<std::uint64_t>("large"), std::uint64_t{1} << 40);
  EXPECT_EQ(first->header.number<std::uint64_t>("time"), std::uint64_t{4} << 32 | 3);
  EXPECT_EQ(bytes.substr(first->data_offset, first->data_size), "data");

  const std::uint64_t behind = first->end();
  const std::optional<Record> second = readRecord(source, behind, scratch);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->kind, RecordKind::kMessage);
  EXPECT_EQ(second->data_size, 0u);
  EXPECT_EQ(second->end(), bytes.size());
}

TEST(RecordBytes, HeadIsThatOfARecordWhoseDataFollow) {
  std::string whole;
  appendRecord(whole, HeaderBytes(RecordKind::kIndex), "1234");
  std::string parts;
  appendRecordHead(parts, HeaderBytes(RecordKind::kIndex), 4);
  EXPECT_EQ(parts + "1234", whole);
}

}  // namespace
}  // namespace fast_edi
