#include "fast_edi/events/event_wire.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace fast_edi {
namespace {

using ::testing::ElementsAreArray;

// dvs_msgs/Event{x: 345, y: 259, ts: 1597849200.123456789, polarity: 1} as roscpp serialises it.
constexpr std::array<std::uint8_t, kWireEventBytes> kGoldenRecord = {
    0x59, 0x01, 0x03, 0x01, 0x70, 0x3e, 0x3d, 0x5f, 0x15, 0xcd, 0x5b, 0x07, 0x01};
constexpr std::int64_t kGoldenTimeNs = 1'597'849'200'123'456'789;

TEST(EventWire, DecodesTheGoldenRecord) {
  const Event event = decodeWireEvent(kGoldenRecord.data());
  EXPECT_EQ(event.x, 345);
  EXPECT_EQ(event.y, 259);
  EXPECT_EQ(event.t_ns, kGoldenTimeNs);
  EXPECT_TRUE(event.on);
}

TEST(EventWire, EncodesTheGoldenRecord) {
  std::vector<std::uint8_t> bytes;
  encodeWireEvent({345, 259, kGoldenTimeNs, true}, bytes);
  EXPECT_THAT(bytes, ElementsAreArray(kGoldenRecord));
}

TEST(EventWire, EncodesManyAsOneByOne) {
  // Within a second, over its end, and back.
  const std::vector<Event> events = {{345, 259, kGoldenTimeNs, true},
                                     {0, 1, kGoldenTimeNs + 1, false},
                                     {2, 3, kGoldenTimeNs + kNanosecondsPerSecond, true},
                                     {4, 5, 0, false},
                                     {6, 7, 999'999'999, true},
                                     {8, 9, kNanosecondsPerSecond, true}};
  std::vector<std::uint8_t> expected = {1, 2, 3};  // what is there stays
  std::vector<std::uint8_t> bytes = expected;
  for (const Event& event : events) {
    encodeWireEvent(event, expected);
  }
  encodeWireEvents(events.data(), events.size(), bytes);
  EXPECT_EQ(bytes, expected);
  encodeWireEvents(nullptr, 0, bytes);
  EXPECT_EQ(bytes, expected);
  // In place; nothing beyond the records is touched.
  constexpr std::uint8_t kBeyond = 77;
  std::vector<std::uint8_t> records(events.size() * kWireEventBytes + 1, kBeyond);
  encodeWireEvents(events.data(), events.size(), records.data());
  EXPECT_EQ(records.back(), kBeyond);
  records.pop_back();
  EXPECT_EQ(records, std::vector<std::uint8_t>(expected.begin() + 3, expected.end()));
}

TEST(EventWire, AnyNonZeroPolarityIsOn) {
  std::array<std::uint8_t, kWireEventBytes> record = kGoldenRecord;
  for (int polarity = 0; polarity <= std::numeric_limits<std::uint8_t>::max(); ++polarity) {
    record.back() = static_cast<std::uint8_t>(polarity);
    EXPECT_EQ(decodeWireEvent(record.data()).on, polarity != 0) << "polarity byte " << polarity;
  }
}

TEST(EventWire, AppendsRecordsThatReadBackInOrder) {
  const std::vector<Event> events = {
      {0, 0, 0, false},
      {1, 2, kNanosecondsPerSecond - 1, true},
      {65535, 65535, (std::int64_t{1} << 32) * kNanosecondsPerSecond - 1, false},
  };
  std::vector<std::uint8_t> bytes = {0xff};  // what was there stays
  for (const Event& event : events) {
    encodeWireEvent(event, bytes);
  }
  ASSERT_EQ(bytes.size(), 1 + events.size() * kWireEventBytes);
  EXPECT_EQ(bytes.front(), 0xff);

  const WireEvents wire{bytes.data() + 1, events.size()};
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event event = decodeWireEvent(wire.record(i));
    EXPECT_EQ(event.x, events[i].x);
    EXPECT_EQ(event.y, events[i].y);
    EXPECT_EQ(event.t_ns, events[i].t_ns);
    EXPECT_EQ(event.on, events[i].on);
  }
}

TEST(EventWire, WritesARecordAndNothingBeside) {
  const Event event{345, 259, kGoldenTimeNs, true};
  std::vector<std::uint8_t> appended;
  encodeWireEvent(event, appended);

  std::vector<std::uint8_t> bytes(kWireEventBytes + 2, 0xab);
  writeWireEvent(event, bytes.data() + 1);
  EXPECT_EQ(bytes.front(), 0xab);
  EXPECT_EQ(bytes.back(), 0xab);
  EXPECT_TRUE(std::equal(appended.begin(), appended.end(), bytes.begin() + 1));
}

TEST(EventWire, FromSkipsRecords) {
  std::vector<std::uint8_t> bytes;
  encodeWireEvent({1, 0, 10, true}, bytes);
  encodeWireEvent({2, 0, 20, true}, bytes);
  const WireEvents wire{bytes.data(), 2};
  EXPECT_EQ(wire.from(1).count, 1u);
  EXPECT_EQ(decodeWireEvent(wire.from(1).data).x, 2);
  EXPECT_TRUE(wire.from(2).empty());
}

}  // namespace
}  // namespace fast_edi
