#include "fast_edi/filters/exposure_events.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(ExposureEvents, CountsOfAPixelStandSideBySide) {
  const std::uint16_t counts[] = {1, 2, 3, 65535};
  const ExposureEvents events{counts, {0.3, 0.2}};
  EXPECT_EQ(events.off(0), 1.0F);
  EXPECT_EQ(events.on(0), 2.0F);
  EXPECT_EQ(events.off(1), 3.0F);
  EXPECT_EQ(events.on(1), 65535.0F);
}

}  // namespace
}  // namespace fast_edi
