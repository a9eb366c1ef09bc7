// Messages, sizes, encodings, stamps and clocks.
#include "validation/stream_checks.hpp"

#include <gmock/gmock.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::namesOf;
using testing::SyntheticRecording;

constexpr std::int64_t kMs = SyntheticRecording::kMs;
constexpr std::int64_t kStart = SyntheticRecording::kStart;

std::vector<std::string> findingsOf(const SyntheticRecording& recording) {
  return namesOf(checkStreams(recording.run()));
}

TEST(StreamChecksTest, ASoundRecordingHasNone) {
  EXPECT_THAT(findingsOf(SyntheticRecording{}), IsEmpty());
}

TEST(StreamChecksTest, SizesAndEncodings) {
  SyntheticRecording changing;
  changing.change_frame = [](int i, FrameMessage& frame) { frame.size.height += i >= 6 ? 8 : 0; };
  EXPECT_THAT(findingsOf(changing), ElementsAre("frame-size-changes"));
  SyntheticRecording other;
  other.change_frame = [](int, FrameMessage& frame) { frame.size = {32, 16}; };
  EXPECT_THAT(findingsOf(other), ElementsAre("sizes-differ"));
  SyntheticRecording unknown;
  unknown.change_frame = [](int, FrameMessage& frame) { frame.fault = "encoding \"x\""; };
  const auto findings = checkStreams(unknown.run());
  ASSERT_THAT(namesOf(findings), ElementsAre("encoding"));
  EXPECT_THAT(findings[0].found, HasSubstr("12 frames with encoding \"x\""));
}

TEST(StreamChecksTest, Losses) {
  SyntheticRecording arrays;
  arrays.has_array = [](int i) { return i != 20; };
  EXPECT_THAT(findingsOf(arrays), ElementsAre("arrays-dropped"));
  SyntheticRecording frames;
  frames.change_frame = [](int i, FrameMessage& frame) { frame.sequence += i >= 6 ? 1 : 0; };
  EXPECT_THAT(findingsOf(frames), ElementsAre("frames-dropped"));
}

TEST(StreamChecksTest, Clocks) {
  SyntheticRecording early;
  early.event_stamp = [](std::int64_t t) { return t < kStart + 30 * kMs ? t - kStart : t; };
  EXPECT_THAT(findingsOf(early), ElementsAre("stamps-near-1970"));

  SyntheticRecording jumping;
  jumping.event_stamp = [](std::int64_t t) { return t < kStart + 200 * kMs ? t : t - 700 * kMs; };
  EXPECT_THAT(findingsOf(jumping), ElementsAre("time-jumps"));

  SyntheticRecording unordered;
  unordered.event_stamp = [](std::int64_t t) { return t / 10'000 % 100 == 0 ? t - 50'000 : t; };
  EXPECT_THAT(findingsOf(unordered), ElementsAre("events-unordered"));

  SyntheticRecording apart;
  apart.event_stamp = [](std::int64_t t) { return t - 3'000 * kMs; };
  const auto findings = checkStreams(apart.run());
  ASSERT_THAT(namesOf(findings), ElementsAre("clocks-differ"));
  EXPECT_THAT(findings[0].found, HasSubstr("behind the frames'"));

  SyntheticRecording repeated;
  repeated.change_frame = [](int i, FrameMessage& frame) {
    frame.stamp_ns -= i == 6 ? 40 * kMs : 0;
  };
  EXPECT_THAT(findingsOf(repeated), ElementsAre("stamps-repeated"));
  SyntheticRecording back;
  back.change_frame = [](int i, FrameMessage& frame) { frame.stamp_ns -= i == 6 ? 50 * kMs : 0; };
  EXPECT_THAT(findingsOf(back), ElementsAre("stamps-backwards"));
}

}  // namespace
}  // namespace fast_edi
