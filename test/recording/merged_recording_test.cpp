#include "recording/merged_recording.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "recording/recording_content.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::readAll;
using testing::RecordingContent;
using ::testing::SizeIs;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{4, 3};

TEST(FrameTimeOf, IsThatOfTheExposureWhereItIsKnown) {
  const std::optional<FrameTime> time = frameTimeOf(9 * kMs, 2 * kMs, 6 * kMs);
  ASSERT_TRUE(time);
  EXPECT_EQ(time->stamp_ns, 4 * kMs);
  EXPECT_EQ(time->exposure, (ExposureInterval{2 * kMs, 6 * kMs}));
}

TEST(FrameTimeOf, IsTheStampOfImpossibleExposures) {
  for (const std::optional<std::int64_t> end :
       {std::optional<std::int64_t>(2 * kMs), std::optional<std::int64_t>(kLastStamp_ns + 1),
        std::optional<std::int64_t>()}) {
    const std::optional<FrameTime> time = frameTimeOf(9 * kMs, 2 * kMs, end);
    ASSERT_TRUE(time);
    EXPECT_EQ(time->stamp_ns, 9 * kMs);
    EXPECT_FALSE(time->exposure);
  }
  EXPECT_FALSE(frameTimeOf(std::nullopt, 2 * kMs, 2 * kMs));
  EXPECT_FALSE(frameTimeOf(-1, std::nullopt, std::nullopt));
  EXPECT_FALSE(frameTimeOf(kLastStamp_ns + 1, std::nullopt, std::nullopt));
}

class Given : public MergedRecording {
 public:
  Given(std::vector<FrameTime> times, std::vector<EventBlock> blocks) : blocks_(std::move(blocks)) {
    addFrames(std::move(times), kSize);
    addEvents(kSize);
  }
  std::string format() const override { return "given"; }
  std::uint64_t position() const override { return 0; }
  std::uint64_t length() const override { return 0; }
  std::uint64_t fileSize() const override { return 0; }

 private:
  bool readFrame(std::size_t index, RecordedFrame& frame) override {
    if (index == 1) {
      note({0, "unreadable"});
      return false;
    }
    frame.size = kSize;
    frame.encoding = "mono8";
    frame.pixels = pixels_.data();
    frame.bytes = pixels_.size();
    return true;
  }
  void readEvents(EventBlock& block) override {
    EXPECT_THAT(block.events, IsEmpty());
    if (next_ < blocks_.size()) {
      block = blocks_[next_++];
    }
  }

  std::vector<EventBlock> blocks_;
  std::size_t next_ = 0;
  const std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(kSize.pixelCount());
};

std::vector<Event> eventsAt(std::initializer_list<std::int64_t> times_ms) {
  std::vector<Event> events;
  for (const std::int64_t t_ms : times_ms) {
    events.push_back({1, 2, t_ms * kMs, true});
  }
  return events;
}

/// E for each event, F for each frame, l before events that were lost; in order.
std::string orderOf(Recording& recording) {
  std::string order;
  RecordingItem item;
  while (recording.next(item)) {
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      order += std::string(events->lost_arrays, 'l') + std::string(events->count, 'E');
    } else {
      order += 'F';
    }
  }
  return order;
}

TEST(MergedRecording, GivesFramesAtTheEndsOfTheirExposures) {
  const std::vector<FrameTime> times = {{ExposureInterval{2 * kMs, 4 * kMs}, 3 * kMs},
                                        {std::nullopt, 5 * kMs},
                                        {std::nullopt, 6 * kMs},
                                        {std::nullopt, 90 * kMs}};
  Given recording(times, {{eventsAt({1, 3, 4}), false}, {eventsAt({5, 6, 7}), true}});
  ASSERT_THAT(recording.streams(), SizeIs(2));
  EXPECT_FALSE(recording.knowsExposures());
  EXPECT_EQ(orderOf(recording), "EEFElEFEEF");
  ASSERT_THAT(recording.damage(), SizeIs(1));
  EXPECT_EQ(recording.damage()[0].what, "unreadable");
}

TEST(MergedRecording, GivesItemsOfAtMostTenMilliseconds) {
  Given recording({}, {{eventsAt({0, 9, 10, 11, 30}), false}});
  std::vector<std::size_t> counts;
  RecordingItem item;
  while (recording.next(item)) {
    counts.push_back(std::get<RecordedEvents>(item.content).count);
  }
  EXPECT_THAT(counts, ElementsAre(2u, 2u, 1u));
}

TEST(MergedRecording, RecordTimesNeverGoBack) {
  Given recording({{std::nullopt, 5 * kMs}},
                  {{eventsAt({8, 2, 7}), false}, {eventsAt({1}), false}});
  const RecordingContent content = readAll(recording);  // which expects it
  EXPECT_THAT(content.events, SizeIs(4));
  EXPECT_THAT(content.frames, SizeIs(1));
}

TEST(MergedRecording, WithoutEventsGivesItsFrames) {
  Given recording({{ExposureInterval{0, 2}, 1}}, {});
  EXPECT_TRUE(recording.knowsExposures());
  EXPECT_EQ(orderOf(recording), "F");
}

}  // namespace
}  // namespace fast_edi
