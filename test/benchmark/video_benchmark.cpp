/// The high-rate video: what an image of it costs, over images and events per exposure. And what it
/// costs that a frame shows another instant than the middle of its exposure.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "optimised_main.hpp"
#include "periodic_stream.hpp"
#include "support/event_generators.hpp"
#include "timing.hpp"

namespace fast_edi::benchmarks {
namespace {

constexpr SensorSize kSize{346, 260};
constexpr std::uint64_t kImageSeed = 7;
/// Vectors grow to their capacity, the period is learned.
constexpr int kWarmUpFrames = 4;
constexpr std::int64_t kMeasuredFrames = 15;

/// Takes images and drops them.
class VideoSink : public FrameSink {
 public:
  MutableImageView begin(const InputFrame&) override { return view(); }
  void finish(const OutputFrame&) override {}
  bool wantsLatentImages() const override { return true; }
  MutableImageView beginLatent(const InputFrame&) override { return view(); }
  void finishLatent(const InputFrame&, std::int64_t) override { ++images; }

  std::uint64_t images = 0;

 private:
  MutableImageView view() {
    return {memory_.data(), kSize, static_cast<std::size_t>(kSize.width), PixelFormat::kMono8};
  }

  std::vector<std::uint8_t> memory_ = std::vector<std::uint8_t>(kSize.pixelCount());
};

enum class Filters { kPlain, kWithoutMotion, kAll };

const char* toString(Filters filters) {
  switch (filters) {
    case Filters::kPlain:
      return "plain";
    case Filters::kWithoutMotion:
      return "without_motion";
    case Filters::kAll:
      return "default";
  }
  return "unknown";
}

DeblurParameters parametersOf(Filters filters, int images) {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.3};
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = kExposure_ns;
  parameters.max_buffered_events = 40'000'000;
  parameters.filter.enabled = filters != Filters::kPlain;
  parameters.filter.motion = filters == Filters::kAll;
  // Learning costs the same whatever the video does.
  parameters.refine_contrast = false;
  parameters.refine_delay = false;
  parameters.latent.per_exposure = images;
  return parameters;
}

/// Time of whole frames, events taken in, deblurred frame and video.
void measure(benchmark::State& state, const DeblurParameters& parameters, std::size_t events) {
  PeriodicStream& stream = sharedStream({testing::EventScene::kMovingEdges, kSize, events});
  VideoSink sink;
  Deblurrer deblurrer(parameters, sink);
  const std::vector<std::uint8_t> blurry = testing::makeGreyImage(kSize, kImageSeed);
  std::uint32_t sequence = 0;
  const auto play = [&] {
    stream.next();
    InputFrame frame;
    frame.stamp_ns = stream.exposure().at(ExposureInstant::kMid);
    frame.image = {blurry.data(), kSize, static_cast<std::size_t>(kSize.width),
                   PixelFormat::kMono8};
    const Stopwatch watch;
    deblurrer.addEvents(stream.all(), kSize, ++sequence, 0);
    deblurrer.addFrame(std::move(frame), 0);
    return watch.seconds();
  };
  for (int i = 0; i < kWarmUpFrames; ++i) play();
  const std::uint64_t images_before = sink.images;
  std::vector<double> seconds;
  for (auto _ : state) {
    seconds.push_back(play());
    state.SetIterationTime(seconds.back());
  }
  constexpr double kMedian = 0.5;
  state.counters["frame_ms"] = percentile(seconds, kMedian) * 1e3;
  state.counters["images"] =
      static_cast<double>(sink.images - images_before) / static_cast<double>(seconds.size());
  if (deblurrer.counters().frames_deblurred != seconds.size() + kWarmUpFrames) {
    state.SkipWithError("a frame was passed through");
  }
}

void addReferences() {
  constexpr std::size_t kEvents = 400'000;
  for (const ExposureInstant reference : {ExposureInstant::kMid, ExposureInstant::kEnd}) {
    DeblurParameters parameters = parametersOf(Filters::kAll, 0);
    parameters.reference = reference;
    const char* name = reference == ExposureInstant::kMid ? "reference/mid" : "reference/end";
    benchmark::RegisterBenchmark(
        name, [=](benchmark::State& state) { measure(state, parameters, kEvents); })
        ->UseManualTime()
        ->Iterations(kMeasuredFrames)
        ->Unit(benchmark::kMillisecond);
  }
}

void addVideos() {
  for (const std::size_t events : {400'000, 4'000'000}) {
    for (const Filters filters : {Filters::kPlain, Filters::kWithoutMotion, Filters::kAll}) {
      for (const int images : {0, 8, 32}) {
        const std::string name = std::string("video/") + toString(filters) + "/" +
                                 std::to_string(events) + "/" + std::to_string(images);
        benchmark::RegisterBenchmark(
            name.c_str(),
            [=](benchmark::State& state) { measure(state, parametersOf(filters, images), events); })
            ->UseManualTime()
            ->Iterations(kMeasuredFrames)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  fast_edi::benchmarks::addVideos();
  fast_edi::benchmarks::addReferences();
  return runBenchmarks(argc, argv);
}
