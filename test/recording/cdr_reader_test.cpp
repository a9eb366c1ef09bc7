#include "recording/cdr_reader.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fast_edi {
namespace {

/// 1 as uint8, 2 as uint32, "ab", 3 as double, bytes {7, 8}: aligned, in either order.
std::vector<std::uint8_t> message(bool big_endian) {
  const std::uint8_t order = big_endian ? 0 : 1;
  if (big_endian) {
    return {0, order, 0, 0, 1, 0, 0, 0,    0, 0, 0, 2, 0, 0, 0, 3, 'a', 'b', 0, 0, 0,
            0, 0,     0, 0, 0, 0, 0, 0x40, 8, 0, 0, 0, 0, 0, 0, 0, 0,   0,   2, 7, 8};
  }
  return {0, order, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0,    0, 'a', 'b', 0, 0, 0,
          0, 0,     0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 0x40, 2, 0,   0,   0, 7, 8};
}

class Cdr : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Orders, Cdr, ::testing::Bool());

TEST_P(Cdr, AlignsEachNumberFromBehindItsHeader) {
  const std::vector<std::uint8_t> bytes = message(GetParam());
  CdrReader cdr(bytes.data(), bytes.size());
  EXPECT_EQ(cdr.isBigEndian(), GetParam());
  EXPECT_EQ(cdr.number<std::uint8_t>(), 1);
  EXPECT_EQ(cdr.number<std::uint32_t>(), 2U);
  EXPECT_EQ(cdr.text(), "ab");
  std::array<double, 1> value = {};
  cdr.skipDoubles(1);
  cdr.doubles(value.data(), value.size());
  EXPECT_EQ(value[0], 3.0);
  const CdrBytes found = cdr.bytes();
  ASSERT_EQ(found.size, 2U);
  EXPECT_EQ(found.data[1], 8);
  EXPECT_EQ(cdr.rest(), 0U);
  EXPECT_TRUE(cdr.ok());
}

TEST_P(Cdr, EndsAtTheEndOfTheMessageWhereverThatIs) {
  const std::vector<std::uint8_t> whole = message(GetParam());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> bytes(whole.begin(),
                                          whole.begin() + static_cast<std::ptrdiff_t>(size));
    CdrReader cdr(bytes.data(), bytes.size());
    cdr.number<std::uint8_t>();
    cdr.number<std::uint32_t>();
    cdr.text();
    cdr.skipDoubles(2);
    cdr.bytes();
    EXPECT_FALSE(cdr.ok()) << size << " bytes";
    EXPECT_EQ(cdr.number<std::uint64_t>(), 0U);
    EXPECT_TRUE(cdr.text().empty());
  }
}

TEST(CdrReader, GivesNoMoreOfASequenceThanThereIs) {
  const std::vector<std::uint8_t> bytes = {0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 5, 6};
  CdrReader strict(bytes.data(), bytes.size());
  EXPECT_EQ(strict.bytes().size, 0U);
  EXPECT_FALSE(strict.ok());
  CdrReader cut(bytes.data(), bytes.size());
  EXPECT_EQ(cut.availableBytes().size, 2U);
  EXPECT_FALSE(cut.ok());
}

TEST(CdrReader, RefusesOtherRepresentations) {
  const std::vector<std::uint8_t> parameters = {0, 3, 0, 0, 1, 0, 0, 0};
  EXPECT_FALSE(CdrReader(parameters.data(), parameters.size()).ok());
}

}  // namespace
}  // namespace fast_edi
