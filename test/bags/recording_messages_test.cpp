#include "fast_edi/bags/recording_messages.hpp"

#include <gmock/gmock.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Int32.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/messages/event_array.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{8, 6};

/// A recording in memory.
class GivenRecording : public Recording {
 public:
  GivenRecording(std::vector<RecordedStream> streams, std::vector<RecordingItem> items)
      : streams_(std::move(streams)), items_(std::move(items)) {}

  std::string format() const override { return "given"; }
  const std::vector<RecordedStream>& streams() const override { return streams_; }
  bool next(RecordingItem& item) override {
    if (at_ == items_.size()) return false;
    item = items_[at_++];
    return true;
  }
  const std::vector<RecordingDamage>& damage() const override { return damage_; }
  std::uint64_t position() const override { return at_; }
  std::uint64_t length() const override { return items_.size(); }
  std::uint64_t fileSize() const override { return 0; }

 private:
  std::vector<RecordedStream> streams_;
  std::vector<RecordingItem> items_;
  std::vector<RecordingDamage> damage_;
  std::size_t at_ = 0;
};

RecordingMessages messagesOf(std::vector<RecordedStream> streams,
                             std::vector<RecordingItem> items = {}, std::int64_t array_ns = 0) {
  return RecordingMessages(std::make_unique<GivenRecording>(std::move(streams), std::move(items)),
                           array_ns);
}

std::vector<std::string> topicsOf(const std::vector<RecordedStream>& streams) {
  std::vector<std::string> topics;
  const RecordingMessages messages = messagesOf(streams);
  for (const auto& [id, connection] : messages.connections()) {
    EXPECT_EQ(connection.id, id);
    EXPECT_EQ(connection.header->at("topic"), connection.topic);
    EXPECT_EQ(connection.header->at("type"), connection.datatype);
    EXPECT_EQ(connection.header->at("md5sum"), connection.md5sum);
    topics.push_back(connection.topic);
  }
  return topics;
}

TEST(RecordingMessages, TheFirstCameraWithEventsIsDvs) {
  EXPECT_THAT(topicsOf({{StreamKind::kFrames, "frames", "other", kSize},
                        {StreamKind::kEvents, "events", "main", kSize},
                        {StreamKind::kImu, "imu", "main", {}},
                        {StreamKind::kTriggers, "triggers", "main", {}},
                        {StreamKind::kCalibration, "calibration", "", kSize},
                        {StreamKind::kEvents, "events", "other", kSize}}),
              UnorderedElementsAre("/other/image_raw", "/other/exposure", "/dvs/events", "/dvs/imu",
                                   "/dvs/camera_info", "/other/events"));
}

TEST(RecordingMessages, NamesOfCamerasBecomeNamesOfTopics) {
  const auto topic_of = [](const std::string& camera) {
    return topicsOf({{StreamKind::kEvents, "events", "first", kSize},
                     {StreamKind::kEvents, "events", camera, kSize}})
        .back();
  };
  EXPECT_EQ(topic_of("left"), "/left/events");
  EXPECT_EQ(topic_of("DAVIS 346-b"), "/DAVIS_346_b/events");
  EXPECT_EQ(topic_of("0left"), "/camera_0left/events");
  EXPECT_EQ(topic_of("rig/left"), "/rig/left/events");
  EXPECT_EQ(topic_of("rig//left/"), "/rig/_left/events");
  EXPECT_EQ(topic_of("/rig"), "/camera__rig/events");
  EXPECT_EQ(topic_of("\xc3\xbc"), "/camera___/events");
}

TEST(RecordingMessages, TheCamerasOwnFramesComeBeforeOthersOfTheSameTopic) {
  EXPECT_THAT(topicsOf({{StreamKind::kFrames, "made of events", "main", kSize},
                        {StreamKind::kFrames, "frames", "main", kSize},
                        {StreamKind::kFrames, "made of events", "main", kSize},
                        {StreamKind::kEvents, "events", "main", kSize}}),
              ElementsAre("/dvs/image_raw", "/dvs/exposure", "/dvs/made_of_events_2/image_raw",
                          "/dvs/made_of_events_2/exposure", "/dvs/made_of_events_3/image_raw",
                          "/dvs/made_of_events_3/exposure", "/dvs/events"));
}

struct Array {
  std::uint32_t sequence;
  std::int64_t stamp_ns;
  std::int64_t record_ns;
  std::vector<std::int64_t> times_ns;

  friend bool operator==(const Array& a, const Array& b) {
    return a.sequence == b.sequence && a.stamp_ns == b.stamp_ns && a.record_ns == b.record_ns &&
           a.times_ns == b.times_ns;
  }
};

std::vector<Event> eventsAt(const std::vector<std::int64_t>& times_ns) {
  std::vector<Event> events;
  for (const std::int64_t t_ns : times_ns) events.push_back({3, 2, t_ns, true});
  return events;
}

/// Event arrays of items with these events, recorded at the time of the last one.
std::vector<Array> arraysOf(const std::vector<std::vector<Event>>& parts, std::int64_t array_ns,
                            std::uint32_t lost_before_last = 0) {
  std::vector<RecordingItem> items;
  for (const std::vector<Event>& part : parts) {
    RecordedEvents events{part.data(), part.size(), 0};
    if (items.size() + 1 == parts.size()) events.lost_arrays = lost_before_last;
    items.push_back({0, part.back().t_ns, events});
  }
  RecordingMessages messages =
      messagesOf({{StreamKind::kEvents, "events", "main", kSize}}, items, array_ns);
  std::vector<Array> arrays;
  BagMessage message;
  while (messages.next(message)) {
    const auto array = deserialise<EventArray>(message);
    EXPECT_EQ(array->width, static_cast<std::uint32_t>(kSize.width));
    EXPECT_EQ(array->height, static_cast<std::uint32_t>(kSize.height));
    Array found{array->header.seq,
                static_cast<std::int64_t>(array->header.stamp.toNSec()),
                static_cast<std::int64_t>(message.time.toNSec()),
                {}};
    for (std::size_t i = 0; i < array->events().count; ++i) {
      found.times_ns.push_back(decodeWireEvent(array->events().record(i)).t_ns);
    }
    arrays.push_back(found);
  }
  return arrays;
}

TEST(RecordingMessages, ArraysAreThoseOfTheRecording) {
  const std::vector<Array> expected = {{0, 5 * kMs, 7 * kMs, {5 * kMs, 6 * kMs, 7 * kMs}},
                                       {3, 8 * kMs, 8 * kMs, {8 * kMs}}};
  EXPECT_EQ(arraysOf({eventsAt({5 * kMs, 6 * kMs, 7 * kMs}), eventsAt({8 * kMs})}, 0, 2), expected);
}

/// Their ends may lie anywhere within the blocks in which they are looked for; a jump back is one.
TEST(RecordingMessages, ArraysMayHaveALengthOfTheirOwn) {
  constexpr std::int64_t kArray_ns = 10 * kMs;
  for (const std::int64_t apart_ns : {kMs / 100, kMs / 26, kMs / 25, kMs, 20 * kMs}) {
    std::vector<std::int64_t> times;
    for (int i = 0; i < 1000; ++i) {
      times.push_back(kMs + (i < 777 ? i : i - 500) * apart_ns);
    }
    std::vector<Array> expected;
    for (const std::int64_t t_ns : times) {
      const bool fits = !expected.empty() && t_ns >= expected.back().stamp_ns &&
                        t_ns < expected.back().stamp_ns + kArray_ns;
      if (!fits) expected.push_back({static_cast<std::uint32_t>(expected.size()), t_ns, 0, {}});
      expected.back().times_ns.push_back(t_ns);
    }
    const std::vector<Event> all = eventsAt(times);
    const std::vector<Event> first(all.begin(), all.begin() + 300);
    const std::vector<Event> second(all.begin() + 300, all.end());
    std::vector<Array> found = arraysOf({first, second}, kArray_ns);
    ASSERT_EQ(found.size(), expected.size()) << apart_ns;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_LE(found[i].record_ns, std::max(first.back().t_ns, second.back().t_ns));
      EXPECT_GE(found[i].record_ns, std::min(first.back().t_ns, second.back().t_ns));
      found[i].record_ns = 0;
      EXPECT_EQ(found[i], expected[i]) << apart_ns << ", " << i;
    }
  }
}

TEST(RecordingMessages, AGapEndsAnArray) {
  const std::vector<Array> expected = {{0, 5 * kMs, 6 * kMs, {5 * kMs}},
                                       {4, 6 * kMs, 6 * kMs, {6 * kMs}}};
  EXPECT_EQ(arraysOf({eventsAt({5 * kMs}), eventsAt({6 * kMs})}, 10 * kMs, 3), expected);
}

TEST(RecordingMessages, FramesComeBeforeTheirExposures) {
  const std::vector<std::uint8_t> pixels(kSize.pixelCount(), 7);
  RecordedFrame frame;
  frame.exposure = ExposureInterval{10 * kMs, 14 * kMs};
  frame.stamp_ns = 12 * kMs;
  frame.size = kSize;
  frame.encoding = "mono8";
  frame.pixels = pixels.data();
  frame.bytes = pixels.size();
  RecordedFrame without = frame;
  without.exposure.reset();
  RecordedImu imu;
  imu.t_ns = 13 * kMs;
  imu.acceleration = {1.0, 2.0, 3.0};
  RecordedCalibration calibration;
  calibration.size = kSize;
  calibration.distortion_model = "plumb_bob";
  calibration.distortion = {0.1, 0.2};
  calibration.camera_matrix[2] = 4.0;
  calibration.rectification[0] = 5.0;
  calibration.projection[11] = 6.0;
  RecordingMessages messages = messagesOf({{StreamKind::kFrames, "frames", "main", kSize},
                                           {StreamKind::kImu, "imu", "main", {}},
                                           {StreamKind::kCalibration, "calibration", "main", kSize},
                                           {StreamKind::kTriggers, "triggers", "main", {}}},
                                          {{0, 14 * kMs, frame},
                                           {3, 15 * kMs, RecordedTrigger{15 * kMs, 1}},
                                           {0, 16 * kMs, without},
                                           {1, 17 * kMs, imu},
                                           {2, 18 * kMs, calibration}});
  BagMessage message;
  ASSERT_TRUE(messages.next(message));
  const auto image = deserialise<sensor_msgs::Image>(message);
  EXPECT_EQ(image->header.stamp.toNSec(), static_cast<std::uint64_t>(12 * kMs));
  EXPECT_EQ(image->header.seq, 0U);
  EXPECT_EQ(image->data, pixels);
  ASSERT_TRUE(messages.next(message));
  EXPECT_EQ(message.connection->topic, "/dvs/exposure");
  EXPECT_EQ(deserialise<std_msgs::Int32>(message)->data, 4000);
  ASSERT_TRUE(messages.next(message));
  EXPECT_EQ(deserialise<sensor_msgs::Image>(message)->header.seq, 1U);
  EXPECT_EQ(message.time.toNSec(), static_cast<std::uint64_t>(16 * kMs));
  ASSERT_TRUE(messages.next(message));
  const auto sample = deserialise<sensor_msgs::Imu>(message);
  EXPECT_EQ(sample->header.stamp.toNSec(), static_cast<std::uint64_t>(13 * kMs));
  EXPECT_EQ(sample->linear_acceleration.y, 2.0);
  ASSERT_TRUE(messages.next(message));
  const auto info = deserialise<sensor_msgs::CameraInfo>(message);
  EXPECT_EQ(info->width, static_cast<std::uint32_t>(kSize.width));
  EXPECT_EQ(info->height, static_cast<std::uint32_t>(kSize.height));
  EXPECT_EQ(info->distortion_model, "plumb_bob");
  EXPECT_THAT(info->D, ElementsAre(0.1, 0.2));
  EXPECT_EQ(info->K[2], 4.0);
  EXPECT_EQ(info->R[0], 5.0);
  EXPECT_EQ(info->P[11], 6.0);
  EXPECT_FALSE(messages.next(message));
  EXPECT_FALSE(messages.next(message));
}

}  // namespace
}  // namespace fast_edi
