// When events came.
#include "survey/event_timeline.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kStart = 1'000 * kNanosecondsPerSecond;

TEST(EventTimelineTest, CountsByMilliseconds) {
  EventTimeline timeline;
  EXPECT_EQ(timeline.longestEpoch(), nullptr);
  for (int i = 0; i < 100; ++i) {
    timeline.add(kStart + i * kMs / 10);
  }
  const EventEpoch* epoch = timeline.longestEpoch();
  ASSERT_NE(epoch, nullptr);
  EXPECT_EQ(epoch->events, 100U);
  EXPECT_EQ(epoch->count({kStart, kStart + 3 * kMs}), 30U);
  EXPECT_EQ(epoch->count({kStart - 5 * kMs, kStart + 100 * kMs}), 100U);
  EXPECT_TRUE(epoch->contains({kStart, kStart + 9 * kMs}));
  EXPECT_FALSE(epoch->contains({kStart, kStart + 10 * kMs}));
  EXPECT_TRUE(epoch->pauses.empty());
}

TEST(EventTimelineTest, KeepsPauses) {
  EventTimeline timeline;
  timeline.add(kStart);
  timeline.add(kStart + EventTimeline::kLeastPause_ns);
  timeline.add(kStart + 10 * kMs);
  ASSERT_EQ(timeline.longestEpoch()->pauses.size(), 1U);
  EXPECT_EQ(timeline.longestEpoch()->pauses[0],
            (ExposureInterval{kStart + EventTimeline::kLeastPause_ns, kStart + 10 * kMs}));
}

TEST(EventTimelineTest, TellsDisorderFromJumps) {
  EventTimeline timeline;
  timeline.add(kStart);
  timeline.add(kStart - 100);
  EXPECT_EQ(timeline.unordered(), 1U);
  EXPECT_EQ(timeline.largestStepBack(), 100);
  EXPECT_EQ(timeline.epochs().size(), 1U);

  timeline.add(kStart - EventTimeline::kMaxBackwardJump_ns - 1);
  EXPECT_EQ(timeline.backwardJumps(), 1U);
  timeline.add(kStart + EventTimeline::kMaxForwardJump_ns);
  EXPECT_EQ(timeline.forwardJumps(), 1U);
  EXPECT_EQ(timeline.epochs().size(), 3U);
  EXPECT_EQ(timeline.events(), 4U);
}

}  // namespace
}  // namespace fast_edi
