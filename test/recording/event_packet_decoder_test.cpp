/// Packets made by hand, after the descriptions of the encodings.
#include "recording/event_packet_decoder.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <tuple>
#include <vector>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint64_t kBase_ns = 1'700'000'000'000'000'000;

using Row = std::tuple<std::uint64_t, int, int, bool>;  // time after kBase_ns, x, y, polarity

template <typename Word>
std::vector<std::uint8_t> bytesOf(const std::vector<Word>& words, bool big_endian) {
  std::vector<std::uint8_t> bytes;
  for (const Word word : words) {
    for (std::size_t i = 0; i < sizeof(word); ++i) {
      const std::size_t place = big_endian ? sizeof(word) - 1 - i : i;
      bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(word) >> (8 * place)));
    }
  }
  return bytes;
}

class Decoding {
 public:
  template <typename Word>
  std::vector<Row> of(const std::string& encoding, const std::vector<Word>& words,
                      bool big_endian = false, std::size_t max = 1000) {
    const std::vector<std::uint8_t> bytes = bytesOf(words, big_endian);
    return ofBytes(encoding, bytes, big_endian, max);
  }
  std::vector<Row> ofBytes(const std::string& encoding, const std::vector<std::uint8_t>& bytes,
                           bool big_endian = false, std::size_t max = 1000) {
    EventPacket packet;
    packet.encoding = encoding;
    packet.time_base_ns = kBase_ns;
    packet.stamp_ns = static_cast<std::int64_t>(kBase_ns);
    packet.big_endian = big_endian;
    packet.data = bytes.data();
    packet.size = bytes.size();
    fault = decoder.begin(packet);
    std::vector<Row> rows;
    bool more = true;
    while (more) {
      std::vector<Event> events;
      more = decoder.decode(events, max);
      for (const Event& event : events) {
        rows.emplace_back(static_cast<std::uint64_t>(event.t_ns) - kBase_ns, event.x, event.y,
                          event.on);
      }
    }
    return rows;
  }

  EventPacketDecoder decoder;
  std::string fault;
};

std::uint32_t libcaerWord(unsigned x, unsigned y, bool on, bool valid = true) {
  return x << 17U | y << 2U | (on ? 2U : 0U) | (valid ? 1U : 0U);
}

class EventPackets : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Orders, EventPackets, ::testing::Bool());

TEST_P(EventPackets, OfLibcaerCountOnWhereTheirTimeWraps) {
  const std::vector<std::uint32_t> words = {
      libcaerWord(345, 259, true),    0x7FFFFFFE, libcaerWord(0, 1, false), 0x7FFFFFFF,
      libcaerWord(9, 9, true, false), 5,          libcaerWord(1, 0, true),  0,
      libcaerWord(2, 0, true),        7};
  const std::uint64_t wrap_ns = 2'147'483'648'000;
  EXPECT_THAT(Decoding().of("libcaer", words, GetParam()),
              ElementsAre(Row(wrap_ns - 2000, 345, 259, true), Row(wrap_ns - 1000, 0, 1, false),
                          Row(wrap_ns, 1, 0, true), Row(wrap_ns + 7000, 2, 0, true)));
}

TEST_P(EventPackets, OfLibcaerMayGoBackALittle) {
  const std::vector<std::uint32_t> words = {libcaerWord(1, 1, true), 100, libcaerWord(2, 1, true),
                                            99};
  EXPECT_THAT(Decoding().of("libcaer", words, GetParam()),
              ElementsAre(Row(100'000, 1, 1, true), Row(99'000, 2, 1, true)));
}

TEST_P(EventPackets, OfCompressedLibcaerHaveSingleEventsAndColumns) {
  const std::vector<std::uint16_t> words = {0x0001,       0x1002,        // 4096 + 2 us
                                            0x2000 | 345, 0x3800 | 259,  // x; y of an ON event
                                            0x1003,       0x4000 | 10,
                                            0x5081,  // OFF events at y = 10 and 17
                                            0x5001,  // and at 18
                                            0x6000};
  Decoding decoding;
  EXPECT_THAT(decoding.of("libcaer_cmp", words, GetParam()),
              ElementsAre(Row(4'098'000, 345, 259, true), Row(4'099'000, 345, 10, false),
                          Row(4'099'000, 345, 17, false), Row(4'099'000, 345, 18, false)));
  EXPECT_EQ(decoding.decoder.unknownWords(), 1U);
}

TEST_P(EventPackets, OfMonoHaveNanoseconds) {
  const std::vector<std::uint64_t> words = {
      std::uint64_t{1} << 63 | std::uint64_t{259} << 48 | std::uint64_t{345} << 32 | 0xFFFFFFFF,
      std::uint64_t{2} << 48 | std::uint64_t{3} << 32 | 1};
  EXPECT_THAT(Decoding().of("mono", words, GetParam()),
              ElementsAre(Row(0xFFFFFFFF, 345, 259, true), Row(1, 3, 2, false)));
}

TEST_P(EventPackets, OfEvt3BeginAtTheirStampOnceTheTimeIsKnown) {
  const std::vector<std::uint16_t> words = {
      0x6001,      0x2805,                          // a time without its upper part: no event yet
      0x8FFF,      0x6FFF, 0x0000 | 7, 0x2800 | 3,  // y, then x of an ON event
      0x8000,      0x6000,                          // the upper part has wrapped: 1 us later
      0x3000 | 20, 0x4801, 0x5002,                  // OFF: x = 20, 31, and 32 + 1
      0xA000,      0xE000, 0x7000,     0xF000,     0x9000, 0xB000};
  Decoding decoding;
  EXPECT_THAT(decoding.of("evt3", words, GetParam()),
              ElementsAre(Row(0, 3, 7, true), Row(1000, 20, 7, false), Row(1000, 31, 7, false),
                          Row(1000, 33, 7, false)));
  EXPECT_EQ(decoding.decoder.unknownWords(), 1U);
  // The next packet goes on in the sensor's time.
  EXPECT_THAT(decoding.of("evt3", std::vector<std::uint16_t>{0x6005, 0x2001}, GetParam()),
              ElementsAre(Row(6000, 1, 7, false)));
}

TEST(EventPacketDecoder, DecodesInPieces) {
  const std::vector<std::uint32_t> words = {
      libcaerWord(1, 1, true), 0x7FFFFFFF, libcaerWord(2, 1, true), 0, libcaerWord(3, 1, false), 1};
  const std::vector<Row> whole = Decoding().of("libcaer", words);
  EXPECT_EQ(whole.size(), 3U);
  EXPECT_EQ(Decoding().of("libcaer", words, false, 1), whole);
}

TEST(EventPacketDecoder, NamesWhatItDoesNotKnow) {
  Decoding decoding;
  EXPECT_THAT(decoding.ofBytes("evt2", {1, 2, 3, 4}), IsEmpty());
  EXPECT_THAT(decoding.fault, HasSubstr("\"evt2\", expected libcaer"));
  EXPECT_THAT(decoding.ofBytes("mono", {1, 2, 3}), IsEmpty());
  EXPECT_THAT(decoding.fault, HasSubstr("multiple of 8"));
}

TEST(EventPacketDecoder, LeavesOutTimesThatNoStampCanTell) {
  const std::vector<std::uint32_t> words = {libcaerWord(1, 1, true), 5};
  const std::vector<std::uint8_t> bytes = bytesOf(words, false);
  EventPacket packet;
  packet.encoding = "libcaer";
  packet.time_base_ns = static_cast<std::uint64_t>(kLastStamp_ns);
  packet.data = bytes.data();
  packet.size = bytes.size();
  EventPacketDecoder decoder;
  EXPECT_EQ(decoder.begin(packet), "");
  std::vector<Event> events;
  EXPECT_FALSE(decoder.decode(events, 10));
  EXPECT_THAT(events, IsEmpty());
  EXPECT_EQ(decoder.untold(), 1U);
}

}  // namespace
}  // namespace fast_edi
