#include "bags/chunk_compression.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

#include "fast_edi/bags/bag_chunk.hpp"

namespace fast_edi {
namespace {

const std::uint8_t* bytesOf(const std::string& text) {
  return reinterpret_cast<const std::uint8_t*>(text.data());
}

std::string someText(std::size_t size) {
  std::mt19937 random(3);
  std::string text(size, ' ');
  for (char& letter : text) {
    letter = static_cast<char>('a' + random() % 4);
  }
  return text;
}

class ChunkCompressionTest : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Both, ChunkCompressionTest, ::testing::Values("bz2", "lz4"));

TEST_P(ChunkCompressionTest, IsUndoneByTheReader) {
  // Less than a block of either, and several.
  for (const std::size_t size : {std::size_t{1}, std::size_t{800'000}, std::size_t{3'000'000}}) {
    const std::string text = someText(size);
    const std::string compressed = compressChunk(GetParam(), text);
    if (size > 1) {
      EXPECT_LT(compressed.size(), size * 2 / 3);
    }
    const ChunkBytes chunk =
        decompressChunk(GetParam(), bytesOf(compressed), compressed.size(), size);
    EXPECT_TRUE(chunk.complete);
    EXPECT_TRUE(chunk.copyable);
    EXPECT_TRUE(std::string(chunk.data.get(), chunk.data.get() + chunk.size) == text) << size;
  }
}

TEST_P(ChunkCompressionTest, IsNotCopiedWithBytesBehindIt) {
  const std::string text = someText(1000);
  const std::string compressed = compressChunk(GetParam(), text) + "more";
  const ChunkBytes chunk =
      decompressChunk(GetParam(), bytesOf(compressed), compressed.size(), text.size());
  EXPECT_TRUE(chunk.complete);
  EXPECT_FALSE(chunk.copyable);
}

TEST(ChunkCompression, KnowsTheFramesOfRosbag) {
  std::string frame = compressChunk("lz4", someText(1000));
  EXPECT_TRUE(isRosbagLz4(frame));
  EXPECT_FALSE(isRosbagLz4(frame.substr(0, 4)));
  EXPECT_FALSE(isRosbagLz4(""));
  frame[4] = static_cast<char>(frame[4] | 0x08);  // the size of the content
  EXPECT_FALSE(isRosbagLz4(frame));
}

}  // namespace
}  // namespace fast_edi
