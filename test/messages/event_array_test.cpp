#include "fast_edi/messages/event_array.hpp"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace fast_edi {
namespace {

namespace ser = ros::serialization;

EventArray someArray() {
  EventArray array;
  array.header.seq = 7;
  array.header.stamp = ros::Time(12, 34);
  array.header.frame_id = "dvs";
  array.height = 260;
  array.width = 346;
  array.append({1, 2, 3'000'000'004, true});
  array.append({345, 259, 4'000'000'005, false});
  return array;
}

template <typename Message>
std::vector<std::uint8_t> serialise(const Message& message) {
  std::vector<std::uint8_t> bytes(ser::serializationLength(message));
  ser::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ser::serialize(stream, message);
  EXPECT_EQ(stream.getLength(), 0u) << "serializedLength() and write() disagree";
  return bytes;
}

template <typename Message>
void deserialise(std::vector<std::uint8_t>& bytes, Message& message) {
  bytes.reserve(1);  // a stream computes with the address of its data, which is none otherwise
  ser::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ser::deserialize(stream, message);
}

/// Offset of the number of events: header {seq, stamp, "dvs"}, height, width.
constexpr std::size_t kCountOffset = 4 + 8 + (4 + 3) + 4 + 4;

TEST(EventArray, IsTheMessageThatDriversPublish) {
  namespace mt = ros::message_traits;
  EXPECT_STREQ(mt::datatype<EventArray>(), "dvs_msgs/EventArray");
  EXPECT_STREQ(mt::md5sum<EventArray>(), "5e8beee5a6c107e504c2e78903c224b8");
  EXPECT_STREQ(mt::md5sum<EventArrayView>(), mt::md5sum<EventArray>());
  // The constant has no definition to be referred to.
  EXPECT_TRUE(static_cast<bool>(mt::IsMessage<EventArray>::value));
  EXPECT_TRUE(mt::hasHeader<EventArray>());
}

TEST(EventArray, LaysFieldsOutAsTheMessageDefinitionSays) {
  const std::vector<std::uint8_t> expected = {
      7,  0, 0, 0, 12, 0, 0, 0, 34, 0, 0, 0, 3, 0, 0, 0, 'd', 'v', 's',  // header
      4,  1, 0, 0, 90, 1, 0, 0,                                          // height, width
      2,  0, 0, 0,                                                       // number of events
      1,  0, 2, 0, 3,  0, 0, 0, 4,  0, 0, 0, 1,                          // ON
      89, 1, 3, 1, 4,  0, 0, 0, 5,  0, 0, 0, 0,                          // OFF
  };
  EXPECT_EQ(serialise(someArray()), expected);
}

TEST(EventArray, ComesBackAsItWasWritten) {
  std::vector<std::uint8_t> bytes = serialise(someArray());
  EventArray array;
  deserialise(bytes, array);
  EXPECT_EQ(array.header.seq, 7u);
  EXPECT_EQ(array.header.stamp, ros::Time(12, 34));
  EXPECT_EQ(array.header.frame_id, "dvs");
  EXPECT_EQ(sensorSize(array), (SensorSize{346, 260}));
  ASSERT_EQ(array.events().count, 2u);
  const Event last = decodeWireEvent(array.events().record(1));
  EXPECT_EQ(last.x, 345);
  EXPECT_EQ(last.y, 259);
  EXPECT_EQ(last.t_ns, 4'000'000'005);
  EXPECT_FALSE(last.on);
}

TEST(EventArray, OwnsItsRecordsAndTheViewPointsIntoTheBuffer) {
  std::vector<std::uint8_t> bytes = serialise(someArray());
  EventArray owner;
  EventArrayView view;
  deserialise(bytes, owner);
  deserialise(bytes, view);
  EXPECT_EQ(view.events().data, bytes.data() + kCountOffset + 4);
  EXPECT_EQ(view.events().count, 2u);
  EXPECT_EQ(serialise(view), bytes);
  bytes.assign(bytes.size(), 0xff);
  EXPECT_EQ(decodeWireEvent(owner.events().record(0)).x, 1);
}

TEST(EventArray, MayBeEmpty) {
  EventArray empty;
  std::vector<std::uint8_t> bytes = serialise(empty);
  EventArray array = someArray();
  deserialise(bytes, array);
  EXPECT_TRUE(array.events().empty());
}

TEST(EventArray, RefusesEveryTruncation) {
  const std::vector<std::uint8_t> whole = serialise(someArray());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::vector<std::uint8_t> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    cut.shrink_to_fit();  // so that a sanitizer sees any byte read beyond
    EventArray owner;
    EXPECT_THROW(deserialise(cut, owner), ser::StreamOverrunException) << size << " bytes";
    EventArrayView view;
    EXPECT_THROW(deserialise(cut, view), ser::StreamOverrunException) << size << " bytes";
  }
}

TEST(EventArray, RefusesCountsBeyondTheMessage) {
  // 0x13b13b14 * 13 is 4 in 32 bits: a check that overflows would let it pass.
  for (const std::uint32_t count : {3u, 0x13b13b14u, 0x7fffffffu, 0xffffffffu}) {
    std::vector<std::uint8_t> bytes = serialise(someArray());
    std::memcpy(bytes.data() + kCountOffset, &count, sizeof(count));
    EventArray array;
    EXPECT_THROW(deserialise(bytes, array), ser::StreamOverrunException) << count;
  }
}

TEST(EventArray, HasNoSensorSizeWhenItStatesAnImpossibleOne) {
  EventArray array = someArray();
  array.width = 32768;
  EXPECT_EQ(sensorSize(array), SensorSize{});
  array.width = 0xffffffffu;
  EXPECT_EQ(sensorSize(array), SensorSize{});
  array.width = 32767;
  EXPECT_EQ(sensorSize(array), (SensorSize{32767, 260}));
}

}  // namespace
}  // namespace fast_edi
