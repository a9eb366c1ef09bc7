#include "pipeline/frame_epoch.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(FrameEpoch, OnlyAStampFurtherBackThanTheLimitFromTheLatestJumps) {
  FrameEpoch epoch;
  EXPECT_FALSE(epoch.jumpsBack(-1000, 10));
  epoch.observe(100);
  epoch.observe(95);  // the latest stays 100
  EXPECT_FALSE(epoch.jumpsBack(90, 10));
  EXPECT_TRUE(epoch.jumpsBack(89, 10));
  EXPECT_EQ(epoch.number(), 0u);
}

TEST(FrameEpoch, ANewOneKnowsOfNoStampBefore) {
  FrameEpoch epoch;
  epoch.observe(100);
  epoch.begin(true);
  EXPECT_EQ(epoch.number(), 1u);
  EXPECT_TRUE(epoch.afterTimeJump());
  EXPECT_FALSE(epoch.jumpsBack(0, 10));
  epoch.begin(false);
  EXPECT_FALSE(epoch.afterTimeJump());
}

TEST(OutputOrder, StampsIncreaseStrictlyWithinAnEpoch) {
  OutputOrder order;
  EXPECT_TRUE(order.isLater(0, INT64_MIN));
  order.observe(0, 10);
  EXPECT_FALSE(order.isLater(0, 10));
  EXPECT_TRUE(order.isLater(0, 11));
  EXPECT_TRUE(order.isLater(1, 5));
  EXPECT_FALSE(order.isLater(0, 10)) << "asking changes nothing";
  order.observe(1, 5);
  EXPECT_FALSE(order.isLater(1, 5));
}

}  // namespace
}  // namespace fast_edi
