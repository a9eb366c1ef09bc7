/// Decoding of the 13-byte wire records: into the event lists, one by one, and field by field as
/// generated message code does it; a plain copy as the lower bound.

#include <cstring>
#include <vector>

#include <benchmark/benchmark.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include "fast_edi/events/pixel_event_lists.hpp"
#include "optimised_main.hpp"
#include "periodic_stream.hpp"

namespace fast_edi::benchmarks {
namespace {

/// Fits the second-level cache as wire records, as one array of a live stream does.
constexpr std::size_t kEventsPerArray = 30'000;
constexpr SensorSize kSize{346, 260};

/// The C++ struct that ROS's message generator makes for dvs_msgs/Event.
struct GeneratedEvent {
  std::uint16_t x;
  std::uint16_t y;
  ros::Time ts;
  std::uint8_t polarity;
};

WireEvents array() {
  const WireEvents all = sharedStream({testing::EventScene::kUniform, kSize, 5'000'000}).all();
  return {all.data, kEventsPerArray};
}

void setRate(benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kEventsPerArray));
}

void plainCopy(benchmark::State& state) {
  const WireEvents events = array();
  std::vector<std::uint8_t> copy(events.count * kWireEventBytes);
  for (auto _ : state) {
    std::memcpy(copy.data(), events.data, copy.size());
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
  }
  setRate(state);
}
BENCHMARK(plainCopy)->Name("wire_decoding/plain_copy");

void intoLists(benchmark::State& state) {
  const WireEvents events = array();
  PixelEventLists lists(kSize, {});
  for (auto _ : state) {
    lists.flush();
    benchmark::DoNotOptimize(lists.append(events).accepted);
  }
  setRate(state);
}
BENCHMARK(intoLists)->Name("wire_decoding/event_lists");

void oneByOne(benchmark::State& state) {
  const WireEvents events = array();
  std::vector<Event> decoded(events.count);
  for (auto _ : state) {
    for (std::size_t i = 0; i < events.count; ++i) decoded[i] = decodeWireEvent(events.record(i));
    benchmark::DoNotOptimize(decoded.data());
    benchmark::ClobberMemory();
  }
  setRate(state);
}
BENCHMARK(oneByOne)->Name("wire_decoding/one_by_one");

void fieldByField(benchmark::State& state) {
  const WireEvents events = array();
  std::vector<std::uint8_t> bytes(events.data, events.data + events.count * kWireEventBytes);
  std::vector<GeneratedEvent> decoded;
  for (auto _ : state) {
    decoded.clear();
    decoded.resize(events.count);
    ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    for (GeneratedEvent& event : decoded) {
      stream.next(event.x);
      stream.next(event.y);
      stream.next(event.ts);
      stream.next(event.polarity);
    }
    benchmark::DoNotOptimize(decoded.data());
    benchmark::ClobberMemory();
  }
  setRate(state);
}
BENCHMARK(fieldByField)->Name("wire_decoding/generated_message_code");

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  return runBenchmarks(argc, argv);
}
