// Frames and the exposure messages that belong to them.
#include "survey/frame_log.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

FrameMessage frame(std::int64_t ms, std::uint32_t sequence) {
  FrameMessage message;
  message.stamp_ns = ms * kMs;
  message.record_ns = (ms + 5) * kMs;
  message.sequence = sequence;
  message.size = {8, 8};
  return message;
}

TEST(FrameLogTest, PairsFramesWithTheirExposures) {
  FrameLog log;
  for (int i = 0; i < 4; ++i) {
    log.addFrame(frame(40 * i, static_cast<std::uint32_t>(i)), 0);
    log.addExposure(10'000 + i, (40 * i + 6) * kMs);
  }
  log.finish();
  ASSERT_EQ(log.frames().size(), 4U);
  EXPECT_EQ(log.frames()[2].length_ns, 10'002'000);
  EXPECT_EQ(log.frames()[2].previous_length_ns, 10'001'000);
  EXPECT_EQ(log.frames()[0].previous_length_ns, 0);
  EXPECT_EQ(log.periodNs(), 40 * kMs);
  EXPECT_EQ(log.gaps(), 0U);
}

TEST(FrameLogTest, CountsWhatIsWrong) {
  FrameLog log;
  log.addFrame(frame(0, 0), 0);
  log.addFrame(frame(40, 1), 0);
  log.addFrame(frame(40, 3), 0);
  FrameMessage bad = frame(20, 4);
  bad.fault = "a reason";
  log.addFrame(bad, 1);
  log.addExposure(-1, 50 * kMs);
  log.finish();
  EXPECT_EQ(log.repeatedStamps(), 1U);
  EXPECT_EQ(log.earlierStamps(), 1U);
  EXPECT_EQ(log.gaps(), 1U);
  EXPECT_EQ(log.faults().at("a reason"), 1U);
  EXPECT_FALSE(log.frames()[3].supported);
  EXPECT_EQ(log.frames()[3].epoch, 1U);
  EXPECT_EQ(log.counters().exposures_refused, 1U);
}

}  // namespace
}  // namespace fast_edi
