#include "fast_edi/base/sensor_size.hpp"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(SensorSize, TheLargestSideIsTheLargestOf16BitsWithASign) {
  EXPECT_EQ(kMaxSide_px, std::numeric_limits<std::int16_t>::max());
}

TEST(SensorSize, IsWrittenWidthFirst) {
  EXPECT_EQ(sizeText(346, 260), "346x260");
  EXPECT_EQ(sizeText(4294967295U, 1), "4294967295x1") << "as any message may state it";
}

}  // namespace
}  // namespace fast_edi
