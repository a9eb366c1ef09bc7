#include "stream/stream_decoder.hpp"

#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>

#include "recording/aedat4_header.hpp"
#include "recording/stored_events.hpp"
#include "stream/served_stream.hpp"
#include "stream/stream_error.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ServedStream;
using ::testing::SizeIs;
using testing::StreamBytes;

FlatBytes bytesOf(const std::string& text, std::size_t from = 0) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()) + from, text.size() - from};
}

ServedStream eventStream(SensorSize size = {346, 260}) {
  StreamBytes bytes({StreamKind::kEvents, "events", "DAVIS346_1", size}, Aedat4Compression::kLz4);
  bytes.add(std::vector<Event>{{1, 2, 3000, true}, {4, 5, 6000, false}});
  return bytes.take();
}

std::string refusal(const std::string& header, StreamKind expected) {
  try {
    const StreamDecoder decoder(bytesOf(header), expected);
  } catch (const StreamError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(StreamDecoder, GivesTheItemsOfAPacket) {
  const ServedStream served = eventStream();
  StreamDecoder decoder(bytesOf(served.header), StreamKind::kEvents);
  EXPECT_EQ(decoder.stream().size.height, 260);
  RecordingItem item;
  EXPECT_FALSE(decoder.next(item)) << "no packet yet";
  decoder.open(0, bytesOf(served.packets.at(0), kAedat4PacketHeaderBytes));
  ASSERT_TRUE(decoder.next(item));
  const auto& events = std::get<RecordedEvents>(item.content);
  ASSERT_EQ(events.count, 2U);
  EXPECT_EQ(events.data[1].t_ns, 6000);
  EXPECT_FALSE(decoder.next(item));
  EXPECT_THAT(decoder.takeDamage(), IsEmpty());
}

TEST(StreamDecoder, MakesFewMessagesOfALargePacket) {
  constexpr std::size_t kMostEvents = 100'000;
  const std::vector<std::uint8_t> packet =
      testing::packetOf(std::vector<testing::StoredEvent>(kMostEvents + 1, {3, 1, 2, 1}));
  const std::string header = StreamBytes({StreamKind::kEvents, "events", "DAVIS346_1", {346, 260}},
                                         Aedat4Compression::kNone)
                                 .take()
                                 .header;
  StreamDecoder decoder(bytesOf(header), StreamKind::kEvents);
  decoder.open(0, {packet.data(), packet.size()});
  RecordingItem item;
  for (const std::size_t expected : {kMostEvents, std::size_t{1}}) {
    ASSERT_TRUE(decoder.next(item));
    EXPECT_EQ(std::get<RecordedEvents>(item.content).count, expected);
  }
  EXPECT_FALSE(decoder.next(item));
}

TEST(StreamDecoder, NotesWhatCannotBeRead) {
  const ServedStream served = eventStream();
  StreamDecoder decoder(bytesOf(served.header), StreamKind::kEvents);
  RecordingItem item;
  decoder.open(0, bytesOf("no LZ4 at all"));
  EXPECT_FALSE(decoder.next(item));
  EXPECT_FALSE(decoder.takeDamage().empty());
  EXPECT_THAT(decoder.takeDamage(), IsEmpty()) << "it was taken";
  decoder.open(1, bytesOf(served.packets.at(0), kAedat4PacketHeaderBytes));
  EXPECT_FALSE(decoder.next(item));
  const std::vector<RecordingDamage> damage = decoder.takeDamage();
  ASSERT_THAT(damage, SizeIs(1));
  EXPECT_EQ(damage[0].offset, 2U) << "the second packet";
  EXPECT_THAT(damage[0].what, HasSubstr("stream 1"));
}

TEST(StreamDecoder, RefusesHeadersThatItCannotUse) {
  const std::string events = eventStream().header;
  EXPECT_EQ(refusal(events, StreamKind::kEvents), "accepted");
  EXPECT_EQ(refusal(events, StreamKind::kImu), "serves events, expected IMU samples");
  EXPECT_THAT(refusal(eventStream({0, 0}).header, StreamKind::kEvents),
              HasSubstr("does not say how large the sensor is"));
  EXPECT_THAT(refusal(std::string(64, '\0'), StreamKind::kEvents), HasSubstr("IOHE"));
}

TEST(StreamDecoder, AHeaderWithADamagedDescriptionSaysSo) {
  std::string header = eventStream().header;
  header.replace(header.find("<dv"), 3, "<xx");
  EXPECT_THAT(refusal(header, StreamKind::kEvents), HasSubstr("serves no stream"));
}

}  // namespace
}  // namespace fast_edi
