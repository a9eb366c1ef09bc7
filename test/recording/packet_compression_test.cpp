#include "../../src/recording/packet_compression.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace fast_edi {
namespace {

constexpr std::size_t kPlenty = std::size_t{16} << 20;

std::vector<std::uint8_t> pattern(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) {
    bytes[i] =
        static_cast<std::uint8_t>(i * (i >> 7) * (i >> 3) >> 5);  // not to be compressed much
  }
  return bytes;
}

class PacketCompression : public ::testing::TestWithParam<Compression> {};
INSTANTIATE_TEST_SUITE_P(Kinds, PacketCompression,
                         ::testing::Values(Compression::kLz4, Compression::kZstd));

TEST_P(PacketCompression, GivesBackWhatWentIn) {
  Decompressor decompressor;
  std::vector<std::uint8_t> compressed;
  RawBytes output;
  for (const std::size_t size : {1U, 1000U, 262144U, 3000000U}) {
    const std::vector<std::uint8_t> plain = pattern(size);
    compress(GetParam(), plain.data(), plain.size(), compressed);
    EXPECT_EQ(decompressor.run(GetParam(), compressed.data(), compressed.size(), kPlenty, output),
              "");
    EXPECT_EQ(std::vector<std::uint8_t>(output.begin(), output.end()), plain);
  }
}

TEST_P(PacketCompression, ABombIsStoppedAtTheLimit) {
  constexpr std::size_t kLimit = 1 << 20;
  const std::vector<std::uint8_t> zeros(kPlenty);
  std::vector<std::uint8_t> compressed;
  compress(GetParam(), zeros.data(), zeros.size(), compressed);
  ASSERT_LT(compressed.size(), kLimit / 8);
  Decompressor decompressor;
  RawBytes output;
  const std::string fault =
      decompressor.run(GetParam(), compressed.data(), compressed.size(), kLimit, output);
  EXPECT_NE(fault.find("larger than 1048576 bytes"), std::string::npos) << fault;
  EXPECT_LE(output.capacity(), kLimit);
}

TEST_P(PacketCompression, TheBeginOfACutFrame) {
  const std::vector<std::uint8_t> plain = pattern(3000000);
  std::vector<std::uint8_t> compressed;
  compress(GetParam(), plain.data(), plain.size(), compressed);
  Decompressor decompressor;
  RawBytes output;
  EXPECT_NE(
      decompressor.run(GetParam(), compressed.data(), compressed.size() * 3 / 4, kPlenty, output),
      "");
  EXPECT_GT(output.size(), plain.size() / 8);
  EXPECT_LT(output.size(), plain.size());
  EXPECT_TRUE(std::equal(output.begin(), output.end(), plain.begin()));
}

TEST_P(PacketCompression, NoiseIsRefused) {
  const std::vector<std::uint8_t> noise = pattern(100);
  Decompressor decompressor;
  RawBytes output;
  EXPECT_NE(decompressor.run(GetParam(), noise.data(), noise.size(), kPlenty, output), "");
  EXPECT_NE(decompressor.run(GetParam(), noise.data(), 0, kPlenty, output), "");
}

}  // namespace
}  // namespace fast_edi
