#include "bags/nothing_deblurred.hpp"

#include <gmock/gmock.h>

#include <cstddef>

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr ClockPair kClocks = {5'000'000'000, 7'000'000'000};

DeblurCounters passedFor(PassReason reason, std::uint64_t frames) {
  DeblurCounters counters;
  counters.frames_in = frames;
  counters.frames_passed[static_cast<std::size_t>(reason)] = frames;
  return counters;
}

TEST(NothingDeblurred, IsNotSaidOfWhatWasDeblurredOrNotToBe) {
  DeblurCounters counters = passedFor(PassReason::kEventsMissing, 29);
  counters.frames_in = 30;
  counters.frames_deblurred = 1;
  EXPECT_THAT(nothingDeblurred(counters, kClocks), IsEmpty());
  EXPECT_THAT(nothingDeblurred(passedFor(PassReason::kPassthroughParameter, 3), kClocks),
              IsEmpty());
}

TEST(NothingDeblurred, NamesWhatMostFramesWerePassedThroughFor) {
  DeblurCounters counters = passedFor(PassReason::kExposureUnknown, 28);
  counters.frames_in = 31;
  counters.frames_passed[static_cast<std::size_t>(PassReason::kEventsMissing)] = 2;
  EXPECT_THAT(nothingDeblurred(counters, kClocks),
              AllOf(HasSubstr("no frame was deblurred: 30 of 31 passed through unchanged, 28 for "
                              "this reason: exposure unknown (give exposure_time_us:="),
                    HasSubstr("--exposure")));
}

TEST(NothingDeblurred, SaysWhatToDoInEachCase) {
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    const auto reason = static_cast<PassReason>(i);
    if (reason == PassReason::kPassthroughParameter) {
      continue;
    }
    SCOPED_TRACE(toString(reason));
    const std::string text = nothingDeblurred(passedFor(reason, 2), kClocks);
    EXPECT_THAT(text, HasSubstr(std::string(toString(reason)) + " ("));
    EXPECT_EQ(text.find(" ()"), std::string::npos);
  }
  EXPECT_THAT(
      nothingDeblurred(passedFor(PassReason::kClocksDiffer, 2), kClocks),
      AllOf(HasSubstr("stamped 5.000 s, the newest event 7.000 s"), HasSubstr("time_offset_us")));
}

TEST(NothingDeblurred, TellsNoFramesFromThoseWhoseStampsDoNotIncrease) {
  DeblurCounters counters;
  EXPECT_THAT(nothingDeblurred(counters, kClocks), HasSubstr("there are none"));
  counters.frames_in = counters.frames_suppressed = 3;
  EXPECT_THAT(nothingDeblurred(counters, kClocks), HasSubstr("the 3 frames do not increase"));
}

}  // namespace
}  // namespace fast_edi
