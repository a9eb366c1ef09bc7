/// Where the default's close spends its time: each of its stages by itself, on the same exposure.

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "calibration/online_calibration.hpp"
#include "fast_edi/events/event_counts.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/filters/frame_noise_estimate.hpp"
#include "fast_edi/filters/frame_noise_filter.hpp"
#include "fast_edi/filters/gain_filter.hpp"
#include "fast_edi/filters/hot_pixel_filter.hpp"
#include "fast_edi/filters/non_local_means.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/latent/latent_image.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "optimised_main.hpp"
#include "periodic_stream.hpp"
#include "timing.hpp"

namespace fast_edi::benchmarks {
namespace {

constexpr ContrastThresholds kThresholds{0.3, 0.3};
constexpr int kWarmUps = 3;
constexpr std::int64_t kRuns = 100;

/// A slope with read noise.
std::vector<std::uint8_t> makeFrame(SensorSize size) {
  constexpr double kNoise_dn = 2.0;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, kNoise_dn);
  std::vector<std::uint8_t> frame;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      constexpr double kDarkest_dn = 50.0, kAcross_dn = 100.0, kDown_dn = 60.0;
      const double level = kDarkest_dn + kAcross_dn * x / size.width + kDown_dn * y / size.height;
      frame.push_back(static_cast<std::uint8_t>(std::lround(level + noise(random))));
    }
  }
  return frame;
}

/// Two exposures with all that the stages take in and give.
class Exposure {
 public:
  explicit Exposure(const StreamSettings& settings)
      : size(settings.size),
        lists(size, {}),
        frame(makeFrame(size)),
        blurry{frame.data(), size, static_cast<std::size_t>(size.width), PixelFormat::kMono8},
        level(frame.begin(), frame.end()),
        counts(size),
        gain(size.pixelCount()),
        scratch(size.pixelCount()),
        variance(size.pixelCount(), 0.004F),
        image(frame.size()) {
    lists.keepIntervals(true);
    PeriodicStream& stream = sharedStream(settings);
    DoubleIntegral integral(size, kThresholds, Weighting::kTime, levelModel(DeblurParameters{}));
    for (int i = 0; i < 2; ++i) {
      stream.next();
      lists.append(stream.all());
      windows[i] = stream.exposure();
      integral.integrate(lists, windows[i], reference(i), gain.data());
      gains[i] = gain;
    }
    counts.count(lists, windows[1]);
    for (std::size_t i = 0; i < gain.size(); ++i) {
      count.push_back(static_cast<float>(counts.off(i) + counts.on(i)));
      log_gain.push_back(std::log(gain[i]));
    }
  }

  std::int64_t reference(int index) const { return windows[index].at(ExposureInstant::kMid); }
  ExposureEvents events() const { return {counts.data(), kThresholds}; }
  MutableImageView out() {
    return {image.data(), size, static_cast<std::size_t>(size.width), PixelFormat::kMono8};
  }

  SensorSize size;
  PixelEventLists lists;
  std::vector<std::uint8_t> frame;
  ImageView blurry;
  std::vector<float> level;
  EventCounts counts;
  ExposureInterval windows[2];
  std::vector<float> gains[2];
  std::vector<float> gain;  ///< of the second exposure
  std::vector<float> count;
  std::vector<float> log_gain;
  std::vector<float> scratch;
  std::vector<float> variance;
  std::vector<std::uint8_t> image;
};

/// \param prepare puts back what the stage changes; its time does not count
void time(benchmark::State& state, const std::function<void()>& prepare,
          const std::function<void()>& stage) {
  std::vector<double> seconds;
  const auto run = [&] {
    prepare();
    const Stopwatch watch;
    stage();
    return watch.seconds();
  };
  for (int i = 0; i < kWarmUps; ++i) run();
  for (auto _ : state) {
    seconds.push_back(run());
    state.SetIterationTime(seconds.back());
  }
  constexpr double kMedian = 0.5;
  state.counters["best_ms"] = percentile(seconds, 0.0) * 1e3;
  state.counters["median_ms"] = percentile(seconds, kMedian) * 1e3;
}

using Stage = std::function<void(benchmark::State&, Exposure&)>;

GainFilter::Settings only(bool GainFilter::Settings::*piece) {
  GainFilter::Settings settings;
  settings.despeckle = settings.smooth = false;
  settings.restore = 0.0F;
  if (piece != nullptr) settings.*piece = true;
  return settings;
}

void filterGains(benchmark::State& state, Exposure& exposure,
                 const GainFilter::Settings& settings) {
  GainFilter filter(exposure.size, settings);
  time(
      state, [&] { exposure.scratch = exposure.gain; },
      [&] { filter.apply(exposure.level.data(), exposure.events(), exposure.scratch.data()); });
}

void writeImage(benchmark::State& state, Exposure& exposure, bool filtered) {
  FilterParameters parameters;
  parameters.enabled = filtered;
  LatentImage image(parameters);
  const CameraResponse response = CameraResponse::linear(0.0);
  time(
      state, [&] { exposure.scratch = exposure.gain; },
      [&] {
        image.write(exposure.blurry, exposure.scratch.data(), exposure.events(), response,
                    exposure.out());
      });
}

void findHotPixels(benchmark::State& state, Exposure& exposure) {
  HotPixelFilter filter(exposure.size);
  time(
      state, [] {},
      [&] { filter.find(exposure.level.data(), exposure.count.data(), exposure.events()); });
}

void averageGains(benchmark::State& state, Exposure& exposure) {
  NonLocalMeans filter(exposure.size, {});
  time(
      state, [] {},
      [&] {
        filter.apply(exposure.log_gain.data(), exposure.variance.data(), exposure.scratch.data());
      });
}

void estimateNoise(benchmark::State& state, Exposure& exposure) {
  FrameNoiseEstimate estimate;
  time(
      state, [] {}, [&] { benchmark::DoNotOptimize(estimate.of(exposure.blurry)); });
}

void filterFrameNoise(benchmark::State& state, Exposure& exposure) {
  FrameNoiseFilter filter(exposure.size, PixelFormat::kMono8, FilterParameters{}.frame_noise_kept);
  time(
      state, [] {},
      [&] { filter.apply(exposure.blurry, 2.0F, exposure.count.data(), exposure.out()); });
}

void keepGains(benchmark::State& state, Exposure& exposure) {
  time(
      state, [] {}, [&] { exposure.scratch = exposure.gain; });
}

void calibrate(benchmark::State& state, Exposure& exposure) {
  const CameraResponse response = CameraResponse::linear(0.0);
  OnlineCalibration::Settings settings;
  settings.level = levelModel(DeblurParameters{});
  const auto frame = [&](int i) {
    return OnlineCalibration::Frame{exposure.windows[i], exposure.reference(i), exposure.blurry,
                                    exposure.gains[i].data()};
  };
  std::unique_ptr<OnlineCalibration> calibration;
  time(
      state,
      [&] {
        calibration =
            std::make_unique<OnlineCalibration>(exposure.size, Calibration{kThresholds}, settings);
        calibration->addFrame(frame(0), response, exposure.lists);
      },
      [&] { calibration->addFrame(frame(1), response, exposure.lists); });
}

void add(const StreamSettings& settings) {
  const std::pair<const char*, Stage> stages[] = {
      {"plain/image", [](auto& state, auto& on) { writeImage(state, on, false); }},
      {"default/image", [](auto& state, auto& on) { writeImage(state, on, true); }},
      {"gain_filter", [](auto& state, auto& on) { filterGains(state, on, {}); }},
      {"gain_filter/log_and_exp",
       [](auto& state, auto& on) { filterGains(state, on, only(nullptr)); }},
      {"gain_filter/despeckle",
       [](auto& state, auto& on) {
         filterGains(state, on, only(&GainFilter::Settings::despeckle));
       }},
      {"gain_filter/smooth",
       [](auto& state, auto& on) { filterGains(state, on, only(&GainFilter::Settings::smooth)); }},
      {"hot_pixels", findHotPixels},
      {"non_local_means", averageGains},
      {"noise_estimate", estimateNoise},
      {"frame_noise_filter", filterFrameNoise},
      {"copy_of_gains", keepGains},
      {"calibration_from_a_pair", calibrate},
  };
  for (const auto& [name, stage] : stages) {
    const std::string full = std::string("stages/") + name + "/" +
                             testing::toString(settings.scene) + "/" + toString(settings.size) +
                             "/" + std::to_string(settings.events_per_exposure);
    benchmark::RegisterBenchmark(full.c_str(),
                                 [settings, stage = stage](benchmark::State& state) {
                                   Exposure exposure(settings);
                                   stage(state, exposure);
                                 })
        ->UseManualTime()
        ->Iterations(kRuns)
        ->Unit(benchmark::kMillisecond);
  }
}

void addAll() {
  constexpr SensorSize kDavis346{346, 260};
  for (const std::size_t events : {400'000, 5'000'000}) {
    add({testing::EventScene::kUniform, kDavis346, events});
    add({testing::EventScene::kMovingEdges, kDavis346, events});
  }
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  fast_edi::benchmarks::addAll();
  return runBenchmarks(argc, argv);
}
