/// What an event array costs that a publisher in the same nodelet manager hands over, up to wire
/// records: as a pointer to the generated message (the package was built with dvs_msgs), and
/// serialised by roscpp for a subscriber of another type (it was not).

#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>
#include <ros/serialization.h>

#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/generated_event_array.hpp"
#include "optimised_main.hpp"
#include "periodic_stream.hpp"
#include "rostest/stand_in/dvs_msgs/EventArray.h"

namespace fast_edi::benchmarks {
namespace {

constexpr SensorSize kSize{346, 260};
/// Arrays of 10 ms, and of 33 ms, at 13 million events per second.
constexpr std::int64_t kShortArray = 130'000;
constexpr std::int64_t kLongArray = 430'000;

dvs_msgs::EventArray generatedArray(std::size_t count) {
  const WireEvents stream = sharedStream({testing::EventScene::kUniform, kSize, 5'000'000}).all();
  dvs_msgs::EventArray array;
  array.width = kSize.width;
  array.height = kSize.height;
  array.events.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Event event = decodeWireEvent(stream.record(i));
    array.events[i].x = event.x;
    array.events[i].y = event.y;
    array.events[i].ts.fromNSec(static_cast<std::uint64_t>(event.t_ns));
    array.events[i].polarity = event.on ? 1 : 0;
  }
  return array;
}

void asPointer(benchmark::State& state) {
  const dvs_msgs::EventArray array = generatedArray(static_cast<std::size_t>(state.range(0)));
  std::vector<std::uint8_t> records;
  for (auto _ : state) {
    benchmark::DoNotOptimize(packGeneratedEvents(array.events, records).data);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(asPointer)->Name("intra_process/pointer")->Arg(kShortArray)->Arg(kLongArray);

void serialised(benchmark::State& state) {
  const dvs_msgs::EventArray array = generatedArray(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    const ros::SerializedMessage bytes = ros::serialization::serializeMessage(array);
    EventArray received;  // a new one for each message, as roscpp makes it
    ros::serialization::deserializeMessage(bytes, received);
    benchmark::DoNotOptimize(received.events().data);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(serialised)->Name("intra_process/serialised")->Arg(kShortArray)->Arg(kLongArray);

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  return runBenchmarks(argc, argv);
}
