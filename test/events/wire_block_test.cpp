#include "events/wire_block.hpp"

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{346, 260};
constexpr std::uint32_t kSecond = 1'600'000'000;
constexpr std::int32_t kSecondDt_ns = 300'000'000;
constexpr std::int32_t kPrevious_ns = kSecondDt_ns + 1000;
constexpr std::size_t kCount = 4 * kWireBlockStride;

constexpr RegularBlock kBlock{kSize, kSecond, kSecondDt_ns, kPrevious_ns};

std::vector<Event> regularEvents(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Event> events;
  std::int64_t nsec = kPrevious_ns - kSecondDt_ns;
  for (std::size_t i = 0; i < kCount; ++i) {
    nsec += random() % 3;
    Event event;
    event.x = static_cast<std::uint16_t>(random() % static_cast<unsigned>(kSize.width));
    event.y = static_cast<std::uint16_t>(random() % static_cast<unsigned>(kSize.height));
    event.on = random() % 2 != 0;
    event.t_ns = kSecond * kNanosecondsPerSecond + nsec;
    events.push_back(event);
  }
  return events;
}

/// The records, and behind them the bytes that may be read beyond.
std::vector<std::uint8_t> records(const std::vector<Event>& events) {
  std::vector<std::uint8_t> bytes;
  for (const Event& event : events) {
    encodeWireEvent(event, bytes);
  }
  bytes.resize(bytes.size() + kWireBlockOverread, 0xff);
  return bytes;
}

struct Unpacked {
  bool regular = false;
  std::vector<PackedEvent> events;
};

Unpacked unpack(const std::vector<std::uint8_t>& bytes, const RegularBlock& block = kBlock) {
  Unpacked unpacked;
  unpacked.events.resize(kCount);
  unpacked.regular = unpackRegularBlock(bytes.data(), kCount, block, unpacked.events.data());
  return unpacked;
}

void expectEqual(const Unpacked& unpacked, const std::vector<Event>& events) {
  ASSERT_TRUE(unpacked.regular);
  for (std::size_t i = 0; i < kCount; ++i) {
    const Event& event = events[i];
    const std::int64_t nsec = event.t_ns - kSecond * kNanosecondsPerSecond;
    EXPECT_EQ(unpacked.events[i].dt_ns, static_cast<std::uint32_t>(nsec + kSecondDt_ns)) << i;
    EXPECT_EQ(
        unpacked.events[i].code,
        static_cast<std::uint32_t>(2 * (event.y * kSize.width + event.x) + (event.on ? 1 : 0)))
        << i;
  }
}

TEST(WireBlock, UnpacksRegularRecords) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    const std::vector<Event> events = regularEvents(seed);
    expectEqual(unpack(records(events)), events);
  }
}

TEST(WireBlock, UnpacksTheLastPixelAndBothEndsOfASecond) {
  std::vector<Event> events = regularEvents(1);
  events.front().x = static_cast<std::uint16_t>(kSize.width - 1);
  events.front().y = static_cast<std::uint16_t>(kSize.height - 1);
  events.front().t_ns = kSecond * kNanosecondsPerSecond;
  events.back().t_ns = (kSecond + 1LL) * kNanosecondsPerSecond - 1;
  RegularBlock block = kBlock;
  block.previous_dt_ns = kSecondDt_ns;
  expectEqual(unpack(records(events), block), events);
}

TEST(WireBlock, TakesAnyOtherPolarityByteThanZeroForOn) {
  const std::vector<Event> events = regularEvents(2);
  std::vector<std::uint8_t> bytes = records(events);
  for (std::size_t i = 0; i < kCount; ++i) {
    std::uint8_t& polarity = bytes[i * kWireEventBytes + kWireEventBytes - 1];
    polarity = polarity != 0 ? static_cast<std::uint8_t>(255 - i) : polarity;
  }
  expectEqual(unpack(bytes), events);
}

TEST(WireBlock, RefusesABlockForAnySingleIrregularRecord) {
  const std::vector<Event> regular = regularEvents(3);
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto refuses = [&](auto change) {
      std::vector<Event> events = regular;
      change(events[i]);
      return !unpack(records(events)).regular;
    };
    EXPECT_TRUE(refuses([](Event& e) { e.x = static_cast<std::uint16_t>(kSize.width); })) << i;
    EXPECT_TRUE(refuses([](Event& e) { e.y = static_cast<std::uint16_t>(kSize.height); })) << i;
    EXPECT_TRUE(refuses([](Event& e) { e.x = UINT16_MAX; })) << i;
    EXPECT_TRUE(refuses([](Event& e) { e.t_ns += kNanosecondsPerSecond; })) << i;
    EXPECT_TRUE(refuses([](Event& e) { e.t_ns -= kNanosecondsPerSecond; })) << i;
    const std::int64_t before_ns =
        i == 0 ? kSecond * kNanosecondsPerSecond + kPrevious_ns - kSecondDt_ns
               : regular[i - 1].t_ns;
    EXPECT_TRUE(refuses([&](Event& e) { e.t_ns = before_ns - 1; })) << i;
  }
}

/// Of a malformed record the block may tell, or unpack it to what decodeWireEvent() reads.
TEST(WireBlock, NeverMisreadsMalformedNanoseconds) {
  const std::vector<Event> events = regularEvents(4);
  for (const std::uint32_t nsec : {1'000'000'000u, 1'500'000'000u, 2'147'483'647u, 2'147'483'648u,
                                   3'000'000'000u, 4'294'967'295u}) {
    std::vector<std::uint8_t> bytes = records(events);
    std::uint8_t* record = bytes.data() + (kCount - 1) * kWireEventBytes;
    for (std::size_t byte = 0; byte < sizeof(nsec); ++byte) {
      record[8 + byte] = static_cast<std::uint8_t>(nsec >> (8 * byte));
    }
    const Unpacked unpacked = unpack(bytes);
    if (unpacked.regular) {
      const std::int64_t dt =
          decodeWireEvent(record).t_ns - kSecond * kNanosecondsPerSecond + kSecondDt_ns;
      EXPECT_EQ(unpacked.events.back().dt_ns, dt) << nsec;
    }
  }
}

TEST(WireBlock, ReadsNoFurtherThanItSays) {
  const std::vector<Event> events = regularEvents(5);
  std::vector<std::uint8_t> bytes = records(events);
  const Unpacked expected = unpack(bytes);
  for (std::size_t i = 0; i < kWireBlockOverread; ++i) {
    bytes[bytes.size() - 1 - i] = static_cast<std::uint8_t>(i);
  }
  bytes.shrink_to_fit();
  expectEqual(unpack(bytes), events);
  EXPECT_TRUE(expected.regular);
}

}  // namespace
}  // namespace fast_edi
