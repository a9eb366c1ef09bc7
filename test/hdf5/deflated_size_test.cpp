#include "hdf5/deflated_size.hpp"

#include <gtest/gtest.h>

#include <zlib.h>

namespace fast_edi {
namespace {

std::vector<std::uint8_t> deflated(std::size_t size) {
  const std::vector<std::uint8_t> zeros(size);
  uLongf count = compressBound(static_cast<uLong>(size));
  std::vector<std::uint8_t> bytes(count);
  EXPECT_EQ(compress(bytes.data(), &count, zeros.data(), static_cast<uLong>(size)), Z_OK);
  bytes.resize(count);
  return bytes;
}

TEST(DeflatedSize, IsExact) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{1} << 15, std::size_t{1'000'000}}) {
    EXPECT_TRUE(inflatesTo(deflated(size), size)) << size;
    EXPECT_FALSE(inflatesTo(deflated(size), size + 1)) << size;
  }
  EXPECT_FALSE(inflatesTo(deflated(1'000'000), 999'999));
}

TEST(DeflatedSize, OfWhatIsCutOrDamagedIsNone) {
  std::vector<std::uint8_t> bytes = deflated(100'000);
  std::vector<std::uint8_t> cut(bytes.begin(), bytes.end() - 3);
  EXPECT_FALSE(inflatesTo(cut, 100'000));
  bytes.back() ^= 1;  // of the checksum
  EXPECT_FALSE(inflatesTo(bytes, 100'000));
  EXPECT_FALSE(inflatesTo({}, 0));
}

}  // namespace
}  // namespace fast_edi
