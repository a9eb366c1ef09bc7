#include "recording/aedat4_packet_decoder.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <variant>
#include <vector>

#include "recording/aedat4_header.hpp"
#include "recording/aedat4_stamp.hpp"
#include "recording/flatbuffer_writer.hpp"
#include "recording/stored_events.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using testing::packetOf;
using testing::StoredEvent;

constexpr std::uint64_t kOffset = 1234;
constexpr std::size_t kEventStream = 0;
constexpr std::size_t kImuStream = 1;

StoredEvent eventAt(std::int64_t t_us) {
  StoredEvent event;
  event.t_us = t_us;
  event.x = 3;
  event.y = -1;
  event.on = 1;
  return event;
}

/// One IMU sample of a time alone.
std::vector<std::uint8_t> samplePacket(std::int64_t t_us) {
  FlatBufferWriter buffer(kAedat4Imu);
  std::vector<FlatBufferWriter::Reference> places;
  buffer.setRoot(buffer.table({FlatBufferWriter::reference(0)}, places));
  const std::vector<FlatBufferWriter::Reference> samples = buffer.references(places[0], 1);
  buffer.refer(samples[0], buffer.table({FlatBufferWriter::number(0, t_us)}, places));
  return buffer.finish();
}

class Aedat4PacketDecoderOf : public ::testing::Test {
 protected:
  Aedat4PacketDecoderOf() : streams_(2) { streams_[kImuStream].kind = StreamKind::kImu; }

  void open(const std::vector<std::uint8_t>& packet, std::size_t stream = kEventStream) {
    packet_ = packet;
    decoder_.open({packet_.data(), packet_.size()}, stream, kOffset);
  }

  std::vector<RecordedStream> streams_;
  std::vector<RecordingDamage> damage_;
  std::vector<std::uint8_t> packet_;
  Aedat4PacketDecoder decoder_{streams_, damage_};
  RecordingItem item_;
};

TEST_F(Aedat4PacketDecoderOf, NothingGivesNothing) {
  EXPECT_FALSE(decoder_.next(item_));
}

TEST_F(Aedat4PacketDecoderOf, EventsLeavesOutThoseWithoutAStamp) {
  open(packetOf({eventAt(5), eventAt(-1), eventAt(INT64_MAX), eventAt(7)}));
  ASSERT_TRUE(decoder_.next(item_));
  const RecordedEvents events = std::get<RecordedEvents>(item_.content);
  ASSERT_EQ(events.count, 2U);
  EXPECT_EQ(events.data[0].t_ns, 5000);
  EXPECT_EQ(events.data[0].x, 3);
  EXPECT_EQ(events.data[0].y, UINT16_MAX) << "beyond any sensor";
  EXPECT_TRUE(events.data[0].on);
  EXPECT_EQ(events.data[1].t_ns, 7000);
  EXPECT_EQ(item_.record_ns, 7000);
  ASSERT_EQ(damage_.size(), 1U);
  EXPECT_EQ(damage_[0].offset, kOffset);
  EXPECT_THAT(damage_[0].what, HasSubstr("2 events with times"));
  EXPECT_FALSE(decoder_.next(item_));
}

TEST_F(Aedat4PacketDecoderOf, MoreEventsThanAnItemTakesComeInSeveral) {
  open(packetOf(std::vector<StoredEvent>(kMaxItemEvents + 1, eventAt(5))));
  for (const std::size_t expected : {kMaxItemEvents, std::size_t{1}}) {
    ASSERT_TRUE(decoder_.next(item_));
    EXPECT_EQ(std::get<RecordedEvents>(item_.content).count, expected);
  }
  EXPECT_FALSE(decoder_.next(item_));
}

TEST_F(Aedat4PacketDecoderOf, ACutPacketGivesTheEventsThatAreThere) {
  std::vector<std::uint8_t> packet = packetOf({eventAt(5), eventAt(6)});
  packet.pop_back();
  open(packet);
  ASSERT_TRUE(decoder_.next(item_));
  EXPECT_EQ(std::get<RecordedEvents>(item_.content).count, 1U);
  ASSERT_EQ(damage_.size(), 1U);
  EXPECT_THAT(damage_[0].what, HasSubstr("shorter than it says: 1 elements are there"));
  EXPECT_FALSE(decoder_.next(item_));
}

TEST_F(Aedat4PacketDecoderOf, AnotherKindOfPacketIsNoted) {
  open(samplePacket(5), kEventStream);
  EXPECT_FALSE(decoder_.next(item_));
  ASSERT_EQ(damage_.size(), 1U);
  EXPECT_EQ(damage_[0].what, "expected a packet with the identifier EVTS");
}

TEST_F(Aedat4PacketDecoderOf, OnePacketAfterTheOtherGivesRecordTimesThatNeverGoBack) {
  open(packetOf({eventAt(9)}));
  ASSERT_TRUE(decoder_.next(item_));
  open(samplePacket(5), kImuStream);
  ASSERT_TRUE(decoder_.next(item_));
  EXPECT_EQ(item_.stream, kImuStream);
  EXPECT_EQ(std::get<RecordedImu>(item_.content).t_ns, 5000);
  EXPECT_EQ(item_.record_ns, 9000);
  EXPECT_TRUE(damage_.empty());
}

TEST(Aedat4Stamp, IsWithinTheStampsOfMessages) {
  constexpr std::int64_t kLast_us = kLastStamp_ns / kNanosecondsPerMicrosecond;
  EXPECT_EQ(aedat4Stamp(0), std::int64_t{0});
  EXPECT_EQ(aedat4Stamp(kLast_us), kLast_us * kNanosecondsPerMicrosecond);
  for (const std::int64_t t_us :
       {std::int64_t{-1}, kLast_us + 1, std::int64_t{INT64_MAX}, std::int64_t{INT64_MIN}}) {
    EXPECT_EQ(aedat4Stamp(t_us), std::nullopt) << t_us;
  }
}

}  // namespace
}  // namespace fast_edi
