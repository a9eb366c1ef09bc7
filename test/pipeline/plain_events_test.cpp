/// Plain events give what the same events as wire records give: images, counters, faults.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/random_schedule.hpp"

namespace fast_edi {
namespace {

using testing::MessageKind;
using testing::Random;
using testing::ScheduledMessage;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{10, 9};
constexpr std::uint64_t kSchedules = 60;

std::vector<Event> decoded(const std::vector<std::uint8_t>& records) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < records.size(); i += kWireEventBytes) {
    events.push_back(decodeWireEvent(records.data() + i));
  }
  return events;
}

bool sameCounts(const DeblurCounters& a, const DeblurCounters& b) {
  return std::memcmp(&a, &b, sizeof(DeblurCounters)) == 0;
}

void deliver(const ScheduledMessage& message, bool plain, Deblurrer& deblurrer) {
  if (message.kind == MessageKind::kFrame) {
    deblurrer.addFrame(testing::frameOf(message), message.now_ns);
  } else if (message.kind == MessageKind::kExposure) {
    deblurrer.addExposure(message.exposure_us, message.now_ns);
  } else if (plain) {
    const std::vector<Event> events = decoded(message.records);
    deblurrer.addEvents(events.data(), events.size(), message.size, message.now_ns);
  } else {  // one number throughout says nothing about lost arrays
    deblurrer.addEvents(testing::wireView(message.records), message.size, 0, message.now_ns);
  }
}

TEST(PlainEvents, GiveTheImagesAndCountersOfWireRecordsUnderAnySchedule) {
  DeblurCounters total;
  for (std::uint64_t seed = 0; seed < kSchedules; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    DeblurParameters parameters;
    parameters.thresholds = {0.3, 0.25};
    parameters.filter.enabled = testing::chance(random, 50);
    parameters.max_buffered_events = static_cast<std::size_t>(testing::uniform(random, 500, 5000));
    parameters.event_mapping.orientation =
        kEventOrientations[static_cast<std::size_t>(testing::uniform(random, 0, 7))].second;
    parameters.event_mapping.polarity =
        testing::chance(random, 50) ? EventPolarity::kNormal : EventPolarity::kInverted;
    testing::RecordingSink of_plain;
    testing::RecordingSink of_wire;
    Deblurrer plain(parameters, of_plain);
    Deblurrer wire(parameters, of_wire);
    for (const ScheduledMessage& message :
         testing::disturbedSchedule(random, kSize, PixelFormat::kMono8)) {
      deliver(message, true, plain);
      deliver(message, false, wire);
    }
    plain.finish();
    wire.finish();
    ASSERT_EQ(of_plain.outputs.size(), of_wire.outputs.size());
    for (std::size_t i = 0; i < of_wire.outputs.size(); ++i) {
      ASSERT_EQ(of_plain.outputs[i].pixels, of_wire.outputs[i].pixels) << "frame " << i;
      ASSERT_EQ(of_plain.outputs[i].frame.stamp_ns, of_wire.outputs[i].frame.stamp_ns);
      ASSERT_EQ(of_plain.outputs[i].frame.events, of_wire.outputs[i].frame.events);
    }
    ASSERT_TRUE(sameCounts(plain.counters(), wire.counters()));
    total.frames_deblurred += wire.counters().frames_deblurred;
    total.event_time_jumps += wire.counters().event_time_jumps;
    total.events_glitched += wire.counters().events_glitched;
    total.events_outside += wire.counters().events_outside;
    total.event_arrays_refused += wire.counters().event_arrays_refused;
  }
  EXPECT_GT(total.frames_deblurred, kSchedules);
  EXPECT_GT(total.event_time_jumps, 0u);
  EXPECT_GT(total.events_glitched, 0u);
  EXPECT_GT(total.events_outside, 0u);
  EXPECT_GT(total.event_arrays_refused, 0u);
}

class PlainEventsTest : public ::testing::Test {
 protected:
  PlainEventsTest() : deblurrer(parametersOf(), sink) {}

  static DeblurParameters parametersOf() {
    DeblurParameters parameters;
    parameters.thresholds = {0.3, 0.25};
    return parameters;
  }
  void add(const std::vector<Event>& events) {
    deblurrer.addEvents(events.data(), events.size(), kSize, 0);
  }

  testing::RecordingSink sink;
  Deblurrer deblurrer;
};

TEST_F(PlainEventsTest, OutsideOfTheTimesOfStampsAreDroppedAndCounted) {
  const std::int64_t end_ns = (std::int64_t{1} << 32) * kNanosecondsPerSecond;
  add({{0, 0, -1, true}, {1, 1, 5 * kMs, true}, {1, 1, end_ns, false}, {1, 1, INT64_MIN, false}});
  EXPECT_EQ(deblurrer.counters().events_in, 4u);
  EXPECT_EQ(deblurrer.counters().events_glitched, 3u);
  EXPECT_EQ(deblurrer.bufferedEvents(), 1u);
}

TEST_F(PlainEventsTest, AnEmptyArrayNeedsNoPointer) {
  deblurrer.addEvents(nullptr, 0, kSize, 0);
  EXPECT_EQ(deblurrer.counters().event_arrays, 1u);
  EXPECT_TRUE(deblurrer.status().events_seen);
}

TEST_F(PlainEventsTest, ArraysWithoutNumbersTellOfNoGap) {
  for (int i = 0; i < 5; ++i) {
    add({{1, 1, i * kMs, true}});
  }
  for (const std::uint32_t sequence : {7u, 8u}) {
    const std::int64_t t_ns = sequence * kMs;
    const std::vector<std::uint8_t> wire = testing::toWire({{1, 1, t_ns, true}});
    deblurrer.addEvents(testing::wireView(wire), kSize, sequence, 0);
    add({{2, 1, t_ns, true}});
  }
  EXPECT_EQ(deblurrer.counters().event_array_gaps, 0u);
  EXPECT_EQ(deblurrer.counters().event_restarts, 0u);
  EXPECT_EQ(deblurrer.bufferedEvents(), 9u);
}

}  // namespace
}  // namespace fast_edi
