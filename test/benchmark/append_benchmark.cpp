/// What taking in one event costs, apart from closing frames, over events per exposure.

#include <string>

#include <benchmark/benchmark.h>

#include "frame_run.hpp"
#include "optimised_main.hpp"

namespace fast_edi::benchmarks {
namespace {

constexpr SensorSize kDavis346{346, 260};

void add(Method method, const StreamSettings& settings) {
  benchmark::RegisterBenchmark(
      ("append/" + runName(method, Exposures::kPeriodic, settings)).c_str(),
      [=](benchmark::State& state) {
        measureFrames(state, method, Exposures::kPeriodic, Part::kTakeIn, settings);
      })
      ->UseManualTime()
      ->Iterations(frameCount(method, settings))
      ->Unit(benchmark::kMillisecond);
}

void addAll() {
  using testing::EventScene;
  const std::size_t counts[] = {10'000, 30'000, 100'000, 400'000, 1'000'000, 5'000'000, 10'000'000};
  for (const SensorSize size : {kDavis346, SensorSize{640, 480}, SensorSize{1280, 720}}) {
    for (const std::size_t events : counts) {
      add(Method::kOurs, {EventScene::kUniform, size, events});
      if (size == kDavis346 || events == 100'000 || events == 1'000'000) {
        add(Method::kPaper, {EventScene::kUniform, size, events});
      }
    }
  }
  for (const std::size_t events : counts) {
    add(Method::kOurs, {EventScene::kMovingEdges, kDavis346, events});
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  fast_edi::benchmarks::addAll();
  return runBenchmarks(argc, argv);
}
