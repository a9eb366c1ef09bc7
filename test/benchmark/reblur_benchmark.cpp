/// filter_reblur: its steps by themselves, and the close of a frame with it, with the default's
/// filters alone, and as plain EDI, on the same moving texture.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "contender.hpp"
#include "fast_edi/events/event_counts.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/latent/latent_image.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "moving_texture.hpp"
#include "optimised_main.hpp"
#include "periodic_stream.hpp"
#include "reblur/reblur.hpp"
#include "timing.hpp"

namespace fast_edi::benchmarks {
namespace {

constexpr SensorSize kSize{346, 260};
constexpr int kWarmUps = 4;
constexpr std::int64_t kRuns = 60;

struct Case {
  std::size_t events_per_exposure;
  double path_px;
};

struct Scene {
  explicit Scene(const Case& settings)
      : texture(moveTexture(kSize, settings.events_per_exposure, settings.path_px)),
        stream(kSize, texture.events) {}

  MovingTexture texture;
  PeriodicStream stream;
};

/// The last one asked for is kept: making one takes longer than measuring with it.
std::shared_ptr<Scene> sceneOf(const Case& settings) {
  static std::size_t events_kept = 0;
  static std::shared_ptr<Scene> kept;
  if (!kept || events_kept != settings.events_per_exposure) {
    kept = std::make_shared<Scene>(settings);
    events_kept = settings.events_per_exposure;
  }
  return kept;
}

/// What reblurring takes in. Events are counted before, as they are while they come.
class Stage {
 public:
  explicit Stage(const Case& settings) : scene_(sceneOf(settings)), lists_(kSize, {}) {
    DeblurParameters parameters;
    parameters.thresholds = scene_->texture.thresholds;
    model_ = {parameters.thresholds, levelModel(parameters)};
    lists_.keepIntervals(true);
    scene_->stream.next();
    lists_.append(scene_->stream.all());
    const ExposureInterval window = scene_->stream.exposure();
    std::vector<float> gain(kSize.pixelCount());
    DoubleIntegral(kSize, model_.thresholds, Weighting::kTime, model_.level)
        .integrate(lists_, window, window.at(ExposureInstant::kMid), gain.data());
    counts_.count(lists_, window);
    quarters_.count(lists_, window);
    image_.resize(kSize.pixelCount());
    latent_.write({scene_->texture.frame.data(), kSize, kSize.width, PixelFormat::kMono8},
                  gain.data(), {counts_.data(), model_.thresholds}, response_, view(image_));
    frame_ = {window,
              latent_.blurryLevels().data(),
              latent_.meanCounts(),
              latent_.frameNoise(),
              counts_.data(),
              &quarters_,
              latent_.cleanLevels()};
  }

  void play() {
    deblurred_ = image_;
    const Stopwatch watch;
    reblur_.apply(frame_, lists_, model_, response_, view(deblurred_));
    seconds_.push_back(watch.seconds());
  }

  double lastSeconds() const { return seconds_.back(); }
  double medianSeconds() const {
    constexpr double kMedian = 0.5;
    return percentile(seconds_, kMedian);
  }
  const Reblur& reblur() const { return reblur_; }
  double meanTrust() const {
    double sum = 0.0;
    for (const float trust : reblur_.trust()) {
      sum += static_cast<double>(trust);
    }
    return sum / static_cast<double>(kSize.pixelCount());
  }

 private:
  static MutableImageView view(std::vector<std::uint8_t>& pixels) {
    return {pixels.data(), kSize, kSize.width, PixelFormat::kMono8};
  }

  std::shared_ptr<Scene> scene_;
  PixelEventLists lists_;
  EventCounts counts_{kSize};
  LaterQuarters quarters_{kSize};
  LatentGains::Model model_;
  CameraResponse response_ = CameraResponse::linear();
  LatentImage latent_{FilterParameters()};
  Reblur::Frame frame_;
  std::vector<std::uint8_t> image_;
  std::vector<std::uint8_t> deblurred_;
  Reblur reblur_;
  std::vector<double> seconds_;
};

void timeStage(benchmark::State& state, const Case& settings) {
  Stage stage(settings);
  for (int i = 0; i < kWarmUps; ++i) {
    stage.play();
  }
  for (auto _ : state) {
    stage.play();
    state.SetIterationTime(stage.lastSeconds());
  }
  constexpr double kLeastTrust = 0.5;
  if (stage.meanTrust() < kLeastTrust) {
    state.SkipWithError("the motion was not trusted, so not much was computed");
    return;
  }
  state.counters["median_ms"] = stage.medianSeconds() * 1e3;
  state.counters["trust"] = stage.meanTrust();
  state.counters["path_px"] = static_cast<double>(stage.reblur().motion().path_px);
}

/// As FrameRun does it, with a frame that belongs to the events.
double close(Contender& contender, Scene& scene, std::vector<std::uint8_t>& latent) {
  scene.stream.next();
  const ExposureInterval exposure = scene.stream.exposure();
  const auto packets_before =
      static_cast<std::size_t>((exposure.end_ns - scene.stream.start()) / kPacket_ns) + 2;
  for (std::size_t i = 0; i < packets_before; ++i) {
    contender.add(scene.stream.packet(i));
  }
  const Stopwatch watch;
  contender.close(exposure, scene.texture.frame.data(), latent.data());
  const double seconds = watch.seconds();
  for (std::size_t i = packets_before; i < scene.stream.packetCount(); ++i) {
    contender.add(scene.stream.packet(i));
  }
  return seconds;
}

/// The methods take turns, so that other work on the machine slows all of them alike.
void timeCloses(benchmark::State& state, const Case& settings) {
  const std::shared_ptr<Scene> scene = sceneOf(settings);
  const Method methods[] = {Method::kOurs, Method::kOursFiltered, Method::kOursReblur};
  std::vector<std::unique_ptr<Contender>> contenders;
  for (const Method method : methods) {
    contenders.push_back(makeContender(method, kSize, scene->texture.thresholds));
  }
  std::vector<std::vector<double>> seconds(contenders.size());
  std::vector<std::uint8_t> latent(kSize.pixelCount());
  for (int i = 0; i < kWarmUps; ++i) {
    for (const auto& contender : contenders) {
      close(*contender, *scene, latent);
    }
  }
  for (auto _ : state) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      seconds[i].push_back(close(*contenders[i], *scene, latent));
    }
    state.SetIterationTime(seconds.back().back());
  }
  constexpr double kMedian = 0.5;
  const double plain = percentile(seconds.front(), kMedian);
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    const double median = percentile(seconds[i], kMedian);
    state.counters[std::string(toString(methods[i])) + "_ms"] = median * 1e3;
    state.counters[std::string(toString(methods[i])) + "_to_plain"] = median / plain;
  }
}

void addAll() {
  constexpr Case kCases[] = {{400'000, 6.0}, {5'000'000, 16.0}};
  for (const Case& settings : kCases) {
    const std::string events = std::to_string(settings.events_per_exposure);
    const auto add = [&](const char* name, void (*run)(benchmark::State&, const Case&)) {
      benchmark::RegisterBenchmark(
          (name + events).c_str(),
          [run, settings](benchmark::State& state) { run(state, settings); })
          ->UseManualTime()
          ->Iterations(kRuns)
          ->Unit(benchmark::kMillisecond);
    };
    add("reblur/stage/", timeStage);
    add("reblur/close/", timeCloses);
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  fast_edi::benchmarks::addAll();
  return runBenchmarks(argc, argv);
}
