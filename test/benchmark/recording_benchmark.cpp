/// Real recordings from the folder that FAST_EDI_RECORDINGS names: wire events in, 8-bit images
/// out. Bags have the topics of the davis driver.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "contender.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "optimised_main.hpp"
#include "support/event_generators.hpp"
#include "timing.hpp"

namespace fast_edi::benchmarks {
namespace {

constexpr char kRecording[] = "davis346_cups.bag";

struct Frame {
  std::int64_t stamp_ns = 0;
  std::int64_t exposure_ns = 0;
  std::vector<std::uint8_t> image;

  /// The driver stamps the middle.
  ExposureInterval exposure() const {
    const std::int64_t start_ns = stamp_ns - exposure_ns / 2;
    return {start_ns, start_ns + exposure_ns};
  }
};

struct Recording {
  SensorSize size;
  std::vector<std::vector<std::uint8_t>> arrays;
  std::vector<Frame> frames;
  std::size_t events = 0;
  std::int64_t length_ns = 0;

  /// Moves all stamps on by the recording's length and a second.
  void moveOn() {
    const std::int64_t by_ns = length_ns + kNanosecondsPerSecond;
    for (std::vector<std::uint8_t>& array : arrays) testing::shiftStamps(by_ns, array);
    for (Frame& frame : frames) frame.stamp_ns += by_ns;
  }
};

std::int64_t lastTime(const WireEvents& events) {
  return decodeWireEvent(events.record(events.count - 1)).t_ns;
}

Recording load(const std::string& path) {
  Recording recording;
  rosbag::Bag bag(path, rosbag::bagmode::Read);
  std::size_t exposures = 0;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (message.getTopic() == "/dvs/events") {
      const auto array = message.instantiate<EventArray>();
      const WireEvents events = array->events();
      recording.size = sensorSize(*array);
      if (events.empty()) continue;
      recording.arrays.emplace_back(events.data, events.data + events.count * kWireEventBytes);
      recording.events += events.count;
    } else if (message.getTopic() == "/dvs/image_raw") {
      const auto image = message.instantiate<sensor_msgs::Image>();
      Frame frame;
      frame.stamp_ns = static_cast<std::int64_t>(image->header.stamp.toNSec());
      frame.image = image->data;
      recording.frames.push_back(std::move(frame));
    } else if (message.getTopic() == "/dvs/exposure") {
      recording.frames.at(exposures++).exposure_ns =
          message.instantiate<std_msgs::Int32>()->data * kNanosecondsPerMicrosecond;
    }
  }
  if (recording.arrays.empty() || exposures != recording.frames.size()) {
    throw std::runtime_error(path + ": expected events and an exposure for each image");
  }
  recording.length_ns = lastTime(testing::wireView(recording.arrays.back())) -
                        decodeWireEvent(recording.arrays.front().data()).t_ns;
  return recording;
}

/// Plays the recording once: each frame is closed as soon as its events are there.
double play(const Recording& recording, Contender& contender, std::vector<std::uint8_t>& latent,
            std::vector<double>& close_s) {
  double total_s = 0.0;
  auto frame = recording.frames.begin();
  bool begun = false;
  for (const std::vector<std::uint8_t>& array : recording.arrays) {
    const WireEvents events = testing::wireView(array);
    const Stopwatch taking_in;
    if (!begun && frame != recording.frames.end()) {
      contender.begin(frame->exposure());
      begun = true;
    }
    contender.add(events);
    total_s += taking_in.seconds();
    while (frame != recording.frames.end() && lastTime(events) >= frame->exposure().end_ns) {
      const Stopwatch closing;
      contender.close(frame->exposure(), frame->image.data(), latent.data());
      close_s.push_back(closing.seconds());
      total_s += close_s.back();
      ++frame;
      begun = false;
    }
  }
  return total_s;
}

void measure(benchmark::State& state, Method method, const std::string& path) {
  constexpr double kMedian = 0.5;
  Recording recording = load(path);
  const std::unique_ptr<Contender> contender = makeContender(method, recording.size);
  std::vector<std::uint8_t> latent(recording.size.pixelCount());
  std::vector<double> close_s, total_s;
  play(recording, *contender, latent, close_s);
  close_s.clear();
  for (auto _ : state) {
    recording.moveOn();
    total_s.push_back(play(recording, *contender, latent, close_s));
    state.SetIterationTime(total_s.back());
  }
  state.counters["events"] = static_cast<double>(recording.events);
  state.counters["frames"] = static_cast<double>(recording.frames.size());
  state.counters["Mev_per_s"] =
      static_cast<double>(recording.events) / percentile(total_s, kMedian) * 1e-6;
  state.counters["close_ms"] = percentile(close_s, kMedian) * 1e3;
}

void addAll(const std::string& folder) {
  constexpr int kRepeats = 20;
  const std::string path = folder + "/" + kRecording;
  for (const Method method : {Method::kOurs, Method::kPaper}) {
    benchmark::RegisterBenchmark(
        (std::string("recording/") + toString(method) + "/" + kRecording).c_str(),
        [=](benchmark::State& state) { measure(state, method, path); })
        ->UseManualTime()
        ->Iterations(kRepeats)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  const char* folder = std::getenv("FAST_EDI_RECORDINGS");
  if (folder == nullptr) {
    std::printf("FAST_EDI_RECORDINGS is not set: no real recording is measured.\n");
    return EXIT_SUCCESS;
  }
  fast_edi::benchmarks::addAll(folder);
  return runBenchmarks(argc, argv);
}
