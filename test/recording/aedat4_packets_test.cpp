#include "recording/aedat4_packets.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <vector>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::uint32_t kContentBytes = 20;
constexpr std::uint32_t kSizeBytes = 4;

/// Packets without compression, as those of a file without header.
class Aedat4PacketsOf : public ::testing::Test {
 protected:
  Aedat4PacketsOf() {
    header_.streams[0].kind = StreamKind::kEvents;
    header_.streams[1].kind = StreamKind::kFrames;
  }
  void putNumber(std::uint32_t number) {
    for (int shift = 0; shift < 32; shift += 8) {
      file_.push_back(static_cast<std::uint8_t>(number >> shift & 0xff));
    }
  }
  /// A packet whose data begin with their size, as a buffer does.
  void put(std::int32_t stream, std::uint32_t stated_bytes = kContentBytes) {
    putNumber(static_cast<std::uint32_t>(stream));
    putNumber(stated_bytes);
    putNumber(kContentBytes - kSizeBytes);
    file_.resize(file_.size() + kContentBytes - kSizeBytes, 0xaa);
  }
  /// The streams of all packets.
  std::vector<std::int32_t> read(bool known_streams = true) {
    const MemorySource source(file_.data(), file_.size());
    Aedat4Packets packets(source, header_, damage_);
    if (known_streams) {
      packets.requireKnownStreams();
    }
    std::vector<std::int32_t> streams;
    Aedat4Packet packet;
    while (packets.next(packet)) {
      EXPECT_LE(packet.offset + packet.size, file_.size());
      EXPECT_TRUE(packets.load(packet));
      EXPECT_EQ(packets.bytes().size, packet.size);
      streams.push_back(packet.stream);
    }
    EXPECT_EQ(packets.position(), packets.length());
    packets.rewind();
    EXPECT_EQ(packets.next(packet), !streams.empty());
    return streams;
  }

  Aedat4Header header_;
  std::vector<std::uint8_t> file_;
  std::vector<RecordingDamage> damage_;
};

TEST_F(Aedat4PacketsOf, AFileComeInItsOrder) {
  put(1);
  put(0);
  put(1);
  EXPECT_THAT(read(), ElementsAre(1, 0, 1));
  EXPECT_TRUE(damage_.empty());
}

TEST_F(Aedat4PacketsOf, ADamagedFileGoOnAtTheNextThatLooksLikeOne) {
  for (const std::uint32_t stated : {0U, 0x7fffffffU, 0x80000000U, 0xffffffffU}) {
    file_.clear();
    damage_.clear();
    put(0);
    const std::size_t damaged = file_.size();
    put(0, stated);
    put(1);
    EXPECT_THAT(read(), ElementsAre(0, 1)) << stated;
    ASSERT_FALSE(damage_.empty());
    EXPECT_EQ(damage_[0].offset, damaged);
    EXPECT_THAT(damage_[0].what, HasSubstr("expected stream 0 1 and 1..48 bytes"));
  }
}

TEST_F(Aedat4PacketsOf, ACutFileEndWithWhatIsThere) {
  put(0);
  const std::size_t first = file_.size();
  put(1);
  const std::vector<std::uint8_t> whole = file_;
  for (std::size_t size = first + 1; size < whole.size(); ++size) {
    file_.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    damage_.clear();
    if (size > first + kAedat4PacketHeaderBytes) {
      EXPECT_THAT(read(), ElementsAre(0, 1)) << size;
    } else {
      EXPECT_THAT(read(), ElementsAre(0)) << size;
    }
    EXPECT_FALSE(damage_.empty()) << size;
  }
}

TEST_F(Aedat4PacketsOf, UnknownStreamsAreDamageOnceStreamsAreKnown) {
  put(0);
  put(7);
  put(1);
  EXPECT_THAT(read(false), ElementsAre(0, 7, 1));
  EXPECT_TRUE(damage_.empty());
  EXPECT_THAT(read(), ElementsAre(0, 1));
  EXPECT_FALSE(damage_.empty());
  header_.streams.clear();
  EXPECT_THAT(read(), ElementsAre(0, 7, 1)) << "a header without streams";
}

}  // namespace
}  // namespace fast_edi
