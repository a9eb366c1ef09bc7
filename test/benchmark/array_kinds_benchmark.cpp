/// What one event costs in large arrays of every kind, beside one in a regular array of the same
/// size: the counter `regular` is the ratio of both in the same run.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "optimised_main.hpp"
#include "support/array_kinds.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi::benchmarks {
namespace {

using testing::ArrayKind;

constexpr SensorSize kDavis346{346, 260};
constexpr std::size_t kEvents = 1'000'000;
constexpr int kIterations = 10;
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kPeriod_ns = 40 * kMs;
/// Between the times of one iteration and the next: no kind goes as far.
constexpr std::int64_t kFar_ns = 41 * kEvents * kNanosecondsPerSecond;

/// Throws images away.
class NoSink : public FrameSink {
 public:
  MutableImageView begin(const InputFrame& input) override {
    pixels_.resize(input.image.size.pixelCount());
    return {pixels_.data(), input.image.size, static_cast<std::size_t>(input.image.size.width),
            PixelFormat::kMono8};
  }
  void finish(const OutputFrame&) override {}

 private:
  std::vector<std::uint8_t> pixels_;
};

/// Arrays and the frames between them; each array goes on where the last one ended.
class Camera {
 public:
  explicit Camera(FrameSink& sink) : deblurrer_(parameters(), sink) {}

  /// Goes on at another time, which two arrays in a row confirm.
  void jumpTo(std::int64_t t_ns) {
    t_ns_ = t_ns;
    for (int i = 0; i < 2; ++i) {
      take(testing::makeArray(ArrayKind::kRegular, kDavis346, 100, t_ns_ += kMs));
    }
  }

  /// One array, and a frame whose exposure lies within its first 40 ms. \return time taken [ns]
  double play(ArrayKind kind) {
    const std::int64_t from_ns = t_ns_ + kMs;
    const std::vector<std::uint8_t> records = testing::makeArray(kind, kDavis346, kEvents, from_ns);
    t_ns_ = decodeWireEvent(testing::wireView(records).record(kEvents - 1)).t_ns;
    const InputFrame frame = testing::makeFlatFrame(from_ns + kPeriod_ns / 2, kDavis346);
    const auto start = std::chrono::steady_clock::now();
    take(records);
    deblurrer_.addFrame(frame, now_ns_);
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start)
        .count();
  }

 private:
  static DeblurParameters parameters() {
    DeblurParameters parameters;
    parameters.thresholds = {0.3, 0.3};
    parameters.exposure_source = ExposureSource::kParameter;
    parameters.exposure_time_ns = 30 * kMs;
    parameters.filter.enabled = false;  // takes its time by the pixel, not by the event
    return parameters;
  }

  void take(const std::vector<std::uint8_t>& records) {
    now_ns_ += kPeriod_ns;
    deblurrer_.addEvents(testing::wireView(records), kDavis346, ++sequence_, now_ns_);
  }

  Deblurrer deblurrer_;
  std::uint32_t sequence_ = 0;
  std::int64_t now_ns_ = 0;
  std::int64_t t_ns_ = 0;
};

void measure(benchmark::State& state, ArrayKind kind) {
  NoSink sink;
  Camera camera(sink);
  double regular_ns = 0.0;
  double own_ns = 0.0;
  std::int64_t start_ns = 0;
  for (auto iteration : state) {
    static_cast<void>(iteration);
    camera.jumpTo(start_ns += kFar_ns);
    camera.play(ArrayKind::kRegular);  // memory is taken
    regular_ns += 2.0 * camera.play(ArrayKind::kRegular);
    const double ns = camera.play(kind) + camera.play(kind);
    own_ns += ns;
    state.SetIterationTime(ns / static_cast<double>(kNanosecondsPerSecond));
  }
  state.counters["ns_per_event"] = own_ns / static_cast<double>(2 * state.iterations()) / kEvents;
  state.counters["regular"] = own_ns / regular_ns;
}

void addAll() {
  for (std::size_t i = 0; i < testing::kArrayKindCount; ++i) {
    const auto kind = static_cast<ArrayKind>(i);
    benchmark::RegisterBenchmark((std::string("array_kinds/") + toString(kind)).c_str(),
                                 [kind](benchmark::State& state) { measure(state, kind); })
        ->UseManualTime()
        ->Iterations(kIterations)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  fast_edi::benchmarks::addAll();
  return runBenchmarks(argc, argv);
}
