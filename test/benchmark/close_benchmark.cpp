/// From the last needed event to the finished 8-bit image, over events per exposure and by what was
/// known of the exposure beforehand.

#include <string>

#include <benchmark/benchmark.h>

#include "frame_run.hpp"
#include "optimised_main.hpp"

namespace fast_edi::benchmarks {
namespace {

void add(Method method, Exposures exposures, const StreamSettings& settings) {
  benchmark::RegisterBenchmark(("close/" + runName(method, exposures, settings)).c_str(),
                               [=](benchmark::State& state) {
                                 measureFrames(state, method, exposures, Part::kClose, settings);
                               })
      ->UseManualTime()
      ->Iterations(frameCount(method, settings))
      ->Unit(benchmark::kMillisecond);
}

void addAll() {
  using testing::EventScene;
  for (const SensorSize size :
       {SensorSize{346, 260}, SensorSize{640, 480}, SensorSize{1280, 720}}) {
    for (const std::size_t events : {10'000, 100'000, 400'000, 1'000'000, 5'000'000}) {
      const StreamSettings settings{EventScene::kUniform, size, events};
      for (const Exposures exposures :
           {Exposures::kPeriodic, Exposures::kJittering, Exposures::kNotPredicted}) {
        add(Method::kOurs, exposures, settings);
      }
      add(Method::kPaper, Exposures::kPeriodic, settings);
    }
  }
  for (const std::size_t events : {400'000, 5'000'000}) {
    for (const Exposures exposures :
         {Exposures::kPeriodic, Exposures::kJittering, Exposures::kNotPredicted}) {
      add(Method::kOurs, exposures, {EventScene::kMovingEdges, {346, 260}, events});
    }
  }
  for (const EventScene scene : {EventScene::kHotPixel, EventScene::kBursts}) {
    for (const Exposures exposures : {Exposures::kPeriodic, Exposures::kNotPredicted}) {
      add(Method::kOurs, exposures, {scene, {346, 260}, 1'000'000});
    }
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  fast_edi::benchmarks::addAll();
  return runBenchmarks(argc, argv);
}
