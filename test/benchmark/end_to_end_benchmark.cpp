/// Wire events in, 8-bit image out: what a frame costs in all, ours against the baselines.

#include <string>

#include <benchmark/benchmark.h>

#include "frame_run.hpp"
#include "optimised_main.hpp"

namespace fast_edi::benchmarks {
namespace {

constexpr SensorSize kDavis346{346, 260};
constexpr SensorSize kVga{640, 480};
constexpr SensorSize kHd{1280, 720};
/// Vanilla EDI is O(events x pixels): its rate is measured on this many.
constexpr std::size_t kVanillaEvents = 5'000;

void add(Method method, Exposures exposures, const StreamSettings& settings) {
  benchmark::RegisterBenchmark(("end_to_end/" + runName(method, exposures, settings)).c_str(),
                               [=](benchmark::State& state) {
                                 measureFrames(state, method, exposures, Part::kAll, settings);
                               })
      ->UseManualTime()
      ->Iterations(frameCount(method, settings))
      ->Unit(benchmark::kMillisecond);
}

void addAll() {
  using testing::EventScene;
  for (const EventScene scene : {EventScene::kUniform, EventScene::kMovingEdges}) {
    for (const std::size_t events : {400'000, 5'000'000}) {
      const StreamSettings settings{scene, kDavis346, events};
      add(Method::kOurs, Exposures::kPeriodic, settings);
      add(Method::kOurs, Exposures::kNotPredicted, settings);
      add(Method::kOursFiltered, Exposures::kPeriodic, settings);
      add(Method::kPaper, Exposures::kPeriodic, settings);
    }
    for (const SensorSize size : {kVga, kHd}) {
      const StreamSettings settings{scene, size, 5'000'000};
      add(Method::kOurs, Exposures::kPeriodic, settings);
      add(Method::kPaper, Exposures::kPeriodic, settings);
    }
    add(Method::kVanilla, Exposures::kPeriodic, {scene, kDavis346, kVanillaEvents});
  }
  for (const EventScene scene : {EventScene::kHotPixel, EventScene::kBursts}) {
    const StreamSettings settings{scene, kDavis346, 1'000'000};
    add(Method::kOurs, Exposures::kPeriodic, settings);
    add(Method::kPaper, Exposures::kPeriodic, settings);
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  fast_edi::benchmarks::addAll();
  return runBenchmarks(argc, argv);
}
