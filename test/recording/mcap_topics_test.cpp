#include "recording/mcap_topics.hpp"

#include <gtest/gtest.h>

#include "recording/mcap_bytes.hpp"
#include "recording/mcap_records.hpp"

namespace fast_edi {
namespace {

using testing::Bytes;
using testing::mcapChannel;
using testing::mcapSchema;

void add(McapTopics& topics, std::uint8_t kind, const Bytes& content) {
  topics.add(kind, content.data(), content.size());
}

TEST(McapTopics, HaveTheTypesOfTheirSchemas) {
  McapTopics topics;
  add(topics, kMcapSchema, mcapSchema(1, "dvs_msgs/msg/EventArray"));
  add(topics, kMcapChannel, mcapChannel(7, 1, "/dvs/events"));
  add(topics, kMcapChannel, mcapChannel(8, 2, "/of_no_schema"));
  ASSERT_EQ(topics.topics().size(), 2U);
  EXPECT_EQ(topics.topics()[0].name, "/dvs/events");
  EXPECT_EQ(topics.topics()[0].type, "dvs_msgs/msg/EventArray");
  EXPECT_EQ(topics.topics()[0].format, "cdr");
  EXPECT_EQ(topics.topics()[1].type, "");
  EXPECT_EQ(topics.find(7), std::size_t{0});
  EXPECT_EQ(topics.find(8), std::size_t{1});
  EXPECT_EQ(topics.find(1), std::nullopt);
}

TEST(McapTopics, AreThoseThatCameFirst) {
  McapTopics topics;
  add(topics, kMcapChannel, mcapChannel(7, 1, "/dvs/events"));
  add(topics, kMcapChannel, mcapChannel(7, 1, "/another"));
  ASSERT_EQ(topics.topics().size(), 1U);
  EXPECT_EQ(topics.topics()[0].name, "/dvs/events");
}

TEST(McapTopics, LeaveOutWhatIsCutOrOfAnotherKind) {
  McapTopics topics;
  const Bytes channel = mcapChannel(7, 1, "/dvs/events");
  add(topics, kMcapMessage, channel);
  // What follows the encoding of messages is not read.
  for (std::size_t size = 0; size < channel.size() - sizeof(std::uint32_t); ++size) {
    topics.add(kMcapChannel, channel.data(), size);
  }
  EXPECT_TRUE(topics.topics().empty());
}

}  // namespace
}  // namespace fast_edi
