#include "evaluation/frames_by_stamp.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(FrameAt, FindsWithinOneMicrosecond) {
  const FramesByStamp frames = {{5'000, cv::Mat()}, {9'000, cv::Mat()}};
  EXPECT_EQ(frameAt(frames, 5'000)->first, 5'000);
  EXPECT_EQ(frameAt(frames, 6'000)->first, 5'000);
  EXPECT_EQ(frameAt(frames, 4'000)->first, 5'000);
  EXPECT_EQ(frameAt(frames, 8'000)->first, 9'000);
  EXPECT_EQ(frameAt(frames, 3'999), frames.end());
  EXPECT_EQ(frameAt(frames, 6'001), frames.end());
  EXPECT_EQ(frameAt(frames, 10'001), frames.end());
}

}  // namespace
}  // namespace fast_edi
