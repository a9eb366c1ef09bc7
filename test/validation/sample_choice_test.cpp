// Pairs of frames for the estimate.
#include "validation/sample_choice.hpp"

#include <gtest/gtest.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using testing::SyntheticRecording;

constexpr std::int64_t kMs = SyntheticRecording::kMs;

SyntheticRecording recording(int frames) {
  SyntheticRecording result;
  result.frames = frames;
  result.change_frame = [](int, FrameMessage& frame) { frame.fault.clear(); };
  return result;
}

TEST(SampleChoiceTest, SpreadsOverTheRecording) {
  const auto requests = chooseSamples(recording(60).run(), 0, 50 * kMs);
  ASSERT_EQ(requests.size(), 12U);
  EXPECT_LT(requests.front().first_frame, 5U);
  EXPECT_GT(requests.back().first_frame, 53U);
  const std::int64_t stamp_ns =
      SyntheticRecording::kStart +
      (20 + 40 * static_cast<std::int64_t>(requests[5].first_frame)) * kMs;
  EXPECT_EQ(requests[5].events, (ExposureInterval{stamp_ns - 70 * kMs, stamp_ns + 110 * kMs}));
}

TEST(SampleChoiceTest, KeepsAwayFromHolesAndBadFrames) {
  SyntheticRecording holed = recording(6);
  holed.has_event = [](std::int64_t t) { return t < 100 * kMs || t >= 110 * kMs; };
  for (const SampleRequest& request : chooseSamples(holed.run(), 0, 10 * kMs)) {
    EXPECT_NE(request.first_frame, 1U);
    EXPECT_NE(request.first_frame, 2U);
  }
  SyntheticRecording bad = recording(6);
  bad.change_frame = [](int i, FrameMessage& frame) { frame.fault = i == 3 ? "bad" : ""; };
  EXPECT_EQ(chooseSamples(bad.run(), 0, 10 * kMs).size(), 3U);
  EXPECT_TRUE(chooseSamples(recording(1).run(), 0, 10 * kMs).empty());
}

}  // namespace
}  // namespace fast_edi
