// Events of each pixel, and pixels that never rest.
#include "survey/pixel_activity.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

TEST(PixelActivityTest, CountsByColumnAndRow) {
  PixelActivity activity({4, 3});
  activity.restart(0);
  activity.add({1, 0, 1 * kMs, true});
  activity.add({1, 2, 2 * kMs, false});
  activity.add({3, 2, 3 * kMs, true});
  EXPECT_EQ(activity.inColumn(0), 0U);
  EXPECT_EQ(activity.inColumn(1), 2U);
  EXPECT_EQ(activity.inColumn(3), 1U);
  EXPECT_EQ(activity.inRow(0), 1U);
  EXPECT_EQ(activity.inRow(1), 0U);
  EXPECT_EQ(activity.inRow(2), 2U);
}

/// Adds one pixel's events, one a millisecond, over half a second.
void addBusyPixel(PixelActivity& activity, std::int64_t start_ns) {
  for (int ms = 0; ms < 500; ++ms) {
    activity.add({2, 3, start_ns + ms * kMs, true});
  }
}

TEST(PixelActivityTest, RatesGoOnOverAJump) {
  PixelActivity activity({8, 8});
  activity.restart(10'000 * kMs);
  addBusyPixel(activity, 10'000 * kMs);
  activity.restart(1'000 * kMs);  // back
  addBusyPixel(activity, 1'000 * kMs);
  const std::vector<HotPixel> hot = activity.hotPixels();
  ASSERT_EQ(hot.size(), 1U);
  EXPECT_EQ(hot[0].x, 2);
  EXPECT_EQ(hot[0].y, 3);
  EXPECT_NEAR(hot[0].rate_hz, 1000.0, 5.0);
}

TEST(PixelActivityTest, AShortRecordingShowsNoHotPixels) {
  PixelActivity activity({8, 8});
  activity.restart(0);
  for (int ms = 0; ms < 300; ++ms) {
    activity.add({2, 3, ms * kMs, true});
  }
  EXPECT_TRUE(activity.hotPixels().empty());
}

}  // namespace
}  // namespace fast_edi
