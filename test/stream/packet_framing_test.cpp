#include "stream/packet_framing.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "stream/stream_error.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string number(std::uint32_t value) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

std::string header(std::size_t bytes = 20) {
  return number(static_cast<std::uint32_t>(bytes)) + number(8) + "IOHE" +
         std::string(bytes - 8, 'h');
}

std::string packet(std::uint32_t stream, const std::string& content) {
  return number(stream) + number(static_cast<std::uint32_t>(content.size())) + content;
}

/// Units that come of \p bytes in pieces of \p piece_bytes: "header" or the packet's stream and
/// content.
std::vector<std::string> unitsOf(const std::string& bytes, std::size_t piece_bytes,
                                 PacketFraming& framing) {
  std::vector<std::string> units;
  for (std::size_t done = 0; done < bytes.size();) {
    const PacketFraming::Room room = framing.room();
    EXPECT_GT(room.size, 0U);
    const std::size_t count = std::min({room.size, piece_bytes, bytes.size() - done});
    std::memcpy(room.data, bytes.data() + done, count);
    done += count;
    const PacketFraming::Unit unit = framing.add(count);
    const FlatBytes content = framing.content();
    if (unit == PacketFraming::Unit::kHeader) {
      units.emplace_back("header");
      EXPECT_TRUE(framing.hasHeader());
    } else if (unit == PacketFraming::Unit::kPacket) {
      units.push_back(std::to_string(framing.stream()) + ":" +
                      std::string(reinterpret_cast<const char*>(content.data), content.size));
    }
  }
  return units;
}

std::string refusal(const std::string& bytes) {
  try {
    PacketFraming framing;
    unitsOf(bytes, bytes.size(), framing);
  } catch (const StreamError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PacketFraming, PiecesOfAnySizeGiveTheSameUnits) {
  const std::string large(200'000, 'x');
  const std::string bytes = header() + packet(0, "first") + packet(3, large) + packet(0, "last");
  for (const std::size_t piece : {1U, 2U, 7U, 4096U, 1U << 20U}) {
    PacketFraming framing;
    EXPECT_THAT(unitsOf(bytes, piece, framing),
                ElementsAre("header", "0:first", "3:" + large, "0:last"))
        << "in pieces of " << piece;
    EXPECT_FALSE(framing.isWithinUnit());
  }
}

TEST(PacketFraming, KnowsWhetherSomethingIsLacking) {
  PacketFraming framing;
  EXPECT_FALSE(framing.isWithinUnit());
  EXPECT_FALSE(framing.hasHeader());
  unitsOf(header().substr(0, 3), 3, framing);
  EXPECT_TRUE(framing.isWithinUnit());
  unitsOf(header().substr(3), 100, framing);
  EXPECT_FALSE(framing.isWithinUnit());
  unitsOf(packet(0, "content").substr(0, 8), 8, framing);
  EXPECT_TRUE(framing.isWithinUnit()) << "a packet without content";
  unitsOf("content", 7, framing);
  EXPECT_FALSE(framing.isWithinUnit());
}

TEST(PacketFraming, RefusesSizesThatNoStreamHas) {
  const std::string head = header();
  EXPECT_THAT(refusal(number(11) + number(8) + "IOHE"), HasSubstr("a header of 11 bytes"));
  EXPECT_THAT(refusal(number(0xffffffff) + number(8) + "IOHE"),
              HasSubstr("a header of 4294967295 bytes, expected 12.."));
  EXPECT_THAT(refusal(head + number(5) + number(0)),
              HasSubstr("a packet of stream 5 with 0 bytes, expected 1.."));
  EXPECT_THAT(refusal(head + number(5) + number(0x80000000)), HasSubstr("-2147483648 bytes"));
  EXPECT_THAT(refusal(head + number(5) + number(PacketFraming::kMaxPacketBytes + 1)),
              HasSubstr("expected 1..33554432"));
  EXPECT_EQ(refusal(head + number(5) + number(PacketFraming::kMaxPacketBytes)), "accepted");
}

TEST(PacketFraming, RefusesWhatIsNoHeader) {
  EXPECT_THAT(refusal(number(20) + number(8) + "EVTS"), HasSubstr("expected the header"));
  PacketFraming framing;
  framing.checkHeaderStart();  // nothing has come yet
  unitsOf("HTTP/", 5, framing);
  EXPECT_THROW(framing.checkHeaderStart(), StreamError);
}

TEST(PacketFraming, ASizeThatIsClaimedTakesNoMemory) {
  PacketFraming framing;
  unitsOf(header() + number(0) + number(PacketFraming::kMaxPacketBytes), 4096, framing);
  unitsOf("few", 3, framing);
  EXPECT_LE(framing.room().size, std::size_t{1} << 20U);
}

}  // namespace
}  // namespace fast_edi
