#include "fast_edi/base/raw_bytes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

namespace fast_edi {
namespace {

TEST(RawBytes, KeepsWhatWasWrittenWhenItGrows) {
  RawBytes bytes(100);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  bytes.resize(100000);
  ASSERT_EQ(bytes.size(), 100000u);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(bytes[i], i + 1);
  }
}

TEST(RawBytes, GrowingWithinItsMemoryLeavesThatMemoryAlone) {
  RawBytes bytes(100, 7);
  bytes.resize(10);
  bytes.resize(100);
  EXPECT_EQ(bytes[99], 7);  // what a std::vector would have set to zero
}

TEST(RawBytes, TakesValuesAsAVectorDoes) {
  const RawBytes bytes(3, 7);
  EXPECT_EQ(bytes, (RawBytes{7, 7, 7}));
  RawBytes copy;
  copy.assign(bytes.begin(), bytes.end());
  EXPECT_EQ(copy, bytes);
}

}  // namespace
}  // namespace fast_edi
