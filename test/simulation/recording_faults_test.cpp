// Faults planted into a simulated recording do what their names say.
#include "simulation/recording_faults.hpp"

#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr SensorSize kSize{20, 10};
constexpr ExposureInterval kExposure{1'000'000, 5'000'000};

TimingSettings timing() {
  TimingSettings timing;
  timing.start_ns = 0;
  timing.frames = 4;
  timing.period_us = 10'000;
  timing.lead_us = 1'000;
  return timing;
}

Event at(std::int64_t us, std::uint16_t x = 5, std::uint16_t y = 5, bool on = true) {
  return {x, y, us * kNanosecondsPerMicrosecond, on};
}

/// Times of the events that are left [us].
std::vector<std::int64_t> left(const std::string& fault, std::vector<Event> events) {
  RecordingFaults faults;
  plantFault(fault, faults);
  FaultyStream stream(faults, kSize, timing());
  stream.apply(kExposure, events);
  std::vector<std::int64_t> times;
  for (const Event& event : events) {
    times.push_back(event.t_ns / kNanosecondsPerMicrosecond);
  }
  return times;
}

TEST(RecordingFaultsTest, FiltersTakeOutWhatTheDriversDo) {
  EXPECT_THAT(left("background-activity-filter=1000",
                   {at(0), at(500, 6), at(2000), at(2100), at(2200, 6, 6), at(2300, 8)}),
              ElementsAre(500, 2200));
  EXPECT_THAT(left("refractory-filter=1000", {at(0), at(500), at(600, 6), at(1000)}),
              ElementsAre(0, 600, 1000));
  EXPECT_THAT(left("skip-filter=2", {at(0), at(1), at(2), at(3), at(4), at(5)}),
              ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(left("suppress-on", {at(0), at(1, 5, 5, false)}), ElementsAre(1));
  EXPECT_THAT(left("suppress-off", {at(0), at(1, 5, 5, false)}), ElementsAre(0));
}

TEST(RecordingFaultsTest, HolesLieWhereTheyAreSaidTo) {
  EXPECT_THAT(left("no-events-between", {at(999), at(1000), at(4999), at(5000)}),
              ElementsAre(1000, 4999));
  EXPECT_THAT(left("event-hole=2", {at(20'999), at(21'000), at(22'999), at(23'000)}),
              ElementsAre(20'999, 23'000));
}

TEST(RecordingFaultsTest, PolaritiesChange) {
  for (const char* fault : {"invert-polarity", "flatten-polarity"}) {
    RecordingFaults faults;
    plantFault(fault, faults);
    std::vector<Event> events = {at(0)};
    FaultyStream(faults, kSize, timing()).apply(kExposure, events);
    EXPECT_FALSE(events[0].on) << fault;
  }
}

TEST(RecordingFaultsTest, EventsAreTurnedSoThatTheOrientationNamedUndoesIt) {
  for (std::size_t i = 0; i < kEventOrientations.size(); ++i) {
    RecordingFaults faults;
    plantFault("event-orientation=" + std::to_string(i), faults);
    FaultyStream stream(faults, kSize, timing());
    std::vector<Event> events = {at(0, 3, 1)};
    stream.apply(kExposure, events);
    const EventMapping undo{EventPolarity::kNormal, kEventOrientations[i].second};
    const SensorSize stated = stream.eventSize(kSize);
    EXPECT_EQ(undo.apply(stated), kSize) << i;
    EXPECT_EQ(undo.apply(events[0], stated).x, 3) << i;
    EXPECT_EQ(undo.apply(events[0], stated).y, 1) << i;
  }
}

TEST(RecordingFaultsTest, CoordinatesMayCountFromOne) {
  RecordingFaults faults;
  plantFault("coordinates-from", faults);
  FaultyStream stream(faults, kSize, timing());
  std::vector<Event> events = {at(0, 19, 9)};
  stream.apply(kExposure, events);
  EXPECT_EQ(events[0].x, 20);
  EXPECT_EQ(events[0].y, 10);
}

TEST(RecordingFaultsTest, UnorderedEventsLieBehindTheirPredecessor) {
  EXPECT_THAT(left("unordered-events=3", {at(1000), at(1001), at(1002), at(1003)}),
              ElementsAre(1000, 1001, 802, 1003));
}

TEST(RecordingFaultsTest, ClocksGoWrong) {
  RecordingFaults faults;
  plantFault("clock-offset=-2", faults);
  const FaultyStream behind(faults, kSize, timing());
  EXPECT_EQ(behind.eventStamp(5000), 3000);
  EXPECT_EQ(behind.eventStamp(1000), 0);
  EXPECT_EQ(behind.frameStamp(5000), 5000);

  RecordingFaults doubled;
  plantFault("frame-stamps-times", doubled);
  EXPECT_EQ(FaultyStream(doubled, kSize, timing()).frameStamp(5000), 10'000);
  EXPECT_EQ(FaultyStream(doubled, kSize, timing()).eventStamp(5000), 5000);

  RecordingFaults jump;
  plantFault("time-jump-back=20", jump);
  plantFault("start-near-1970=1", jump);
  TimingSettings later = timing();
  later.start_ns = kNanosecondsPerSecond;
  const FaultyStream jumping(jump, kSize, later);
  EXPECT_EQ(jumping.frameStamp(later.start_ns + 500), 500);
  EXPECT_EQ(jumping.frameStamp(later.start_ns + 20'000'000), later.start_ns + 20'000'000);
  EXPECT_EQ(jumping.eventStamp(later.start_ns + 21'000'000), later.start_ns + 1'000'000);
}

TEST(RecordingFaultsTest, NamesAndValuesAreChecked) {
  RecordingFaults faults;
  EXPECT_THROW(plantFault("no-such-fault", faults), std::invalid_argument);
  EXPECT_THROW(plantFault("event-hole=x", faults), std::invalid_argument);
  EXPECT_THROW(plantFault("event-hole=", faults), std::invalid_argument);
  for (const FaultDescription& description : faultDescriptions()) {
    plantFault(description.name, faults);
    EXPECT_EQ(faults.*description.value, description.usual);
  }
  EXPECT_THAT(left("event-hole=0", {}), IsEmpty());
}

}  // namespace
}  // namespace fast_edi
