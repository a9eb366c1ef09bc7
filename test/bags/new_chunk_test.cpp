#include "bags/new_chunk.hpp"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/bag_record.hpp"

namespace fast_edi {
namespace {

TEST(NewChunk, HoldsConnectionsAndMessages) {
  BagConnection connection;
  connection.id = 9;
  connection.topic = "/topic";
  connection.header = boost::make_shared<ros::M_string>();
  (*connection.header)["latching"] = "1";
  NewChunk chunk;
  EXPECT_TRUE(chunk.empty());
  chunk.add(connection);
  EXPECT_FALSE(chunk.empty());
  const std::vector<std::uint8_t> message{1, 2, 3};
  chunk.add(9, {5, 6}, message.data(), 3);
  chunk.add(9, {7, 8}, nullptr, 0);

  const std::string& bytes = chunk.bytes();
  const MemorySource source(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  std::vector<std::uint8_t> scratch;
  const std::optional<Record> first = readRecord(source, 0, scratch);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->kind, RecordKind::kConnection);
  EXPECT_EQ(first->header.text("topic"), "/topic");
  const std::optional<RecordHeader> description =
      RecordHeader::parse(std::string_view(bytes).substr(first->data_offset, first->data_size));
  ASSERT_TRUE(description);
  EXPECT_EQ(description->text("latching"), "1");
  const std::uint64_t at = first->end();
  const std::optional<Record> second = readRecord(source, at, scratch);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->kind, RecordKind::kMessage);
  EXPECT_EQ(second->header.number<std::uint32_t>("conn"), 9u);
  EXPECT_EQ(second->header.number<std::uint64_t>("time"), std::uint64_t{6} << 32 | 5);
  EXPECT_EQ(bytes.substr(second->data_offset, second->data_size), "\x01\x02\x03");
  const std::optional<Record> third = readRecord(source, second->end(), scratch);
  ASSERT_TRUE(third);
  EXPECT_EQ(third->end(), bytes.size());
}

TEST(NewChunk, IsFullWhereRosbagsAre) {
  NewChunk chunk;
  const std::vector<std::uint8_t> message(100'000);
  int messages = 0;
  for (; !chunk.isFull(); ++messages) {
    chunk.add(0, {1, 0}, message.data(), static_cast<std::uint32_t>(message.size()));
  }
  EXPECT_EQ(messages, 8);  // 768 kB
}

TEST(NewChunk, RefusesMoreThanAnIndexReaches) {
  NewChunk chunk;
  const std::vector<std::uint8_t> message(1000);
  chunk.add(0, {1, 0}, message.data(), 1000);
  // It is refused before any of it is read.
  EXPECT_THROW(chunk.add(0, {1, 0}, message.data(), UINT32_MAX - 500), BagError);
  EXPECT_LT(chunk.bytes().size(), 1100u);
}

}  // namespace
}  // namespace fast_edi
