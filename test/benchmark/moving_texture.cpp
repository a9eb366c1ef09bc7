#include "moving_texture.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "periodic_stream.hpp"

namespace fast_edi::benchmarks {
namespace {

constexpr unsigned kSeed = 11;
constexpr int kSteps = 80;  ///< of a period
constexpr double kPi = 3.14159265358979;

struct Wave {
  double x;  ///< [rad/px]
  double y;
  double phase;
  double amplitude;  ///< of log intensity
};

/// Long ones as well: of short ones alone, a motion by a wavelength more fits as well.
std::vector<Wave> makeWaves(std::mt19937& random) {
  constexpr int kWaves = 14;
  constexpr int kFaintWaves = 3;  // which alone would hardly cause an event
  constexpr double kShortest_px = 7.0, kLongest_px = 120.0, kAmplitude = 0.2, kFaint = 0.03;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    const double length_px = kShortest_px * std::pow(kLongest_px / kShortest_px, share(random));
    const double angle = 2.0 * kPi * share(random);
    const double rate = 2.0 * kPi / length_px;
    waves.push_back({rate * std::cos(angle), rate * std::sin(angle), 2.0 * kPi * share(random),
                     i < kFaintWaves ? kFaint : kAmplitude});
  }
  return waves;
}

/// Log intensities of all pixels at all steps, [step][pixel].
std::vector<std::vector<float>> render(SensorSize size, double path_px,
                                       const std::vector<Wave>& waves) {
  constexpr double kRight = 0.8, kDown = 0.6;  // of the path
  const double period_path_px =
      path_px * static_cast<double>(kPeriod_ns) / static_cast<double>(kExposure_ns);
  std::vector<std::vector<float>> steps;
  for (int step = 0; step <= kSteps; ++step) {
    const double way = period_path_px * step / kSteps;
    std::vector<float> log(size.pixelCount());
    std::size_t i = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x, ++i) {
        double sum = 0.0;
        for (const Wave& wave : waves) {
          sum += wave.amplitude *
                 std::cos(wave.x * (x + kRight * way) + wave.y * (y + kDown * way) + wave.phase);
        }
        log[i] = static_cast<float>(sum);
      }
    }
    steps.push_back(std::move(log));
  }
  return steps;
}

double thresholdFor(const std::vector<std::vector<float>>& steps, std::size_t events_per_exposure) {
  double variation = 0.0;
  for (std::size_t step = 1; step < steps.size(); ++step) {
    for (std::size_t i = 0; i < steps[step].size(); ++i) {
      variation += static_cast<double>(std::abs(steps[step][i] - steps[step - 1][i]));
    }
  }
  return variation * static_cast<double>(kExposure_ns) / static_cast<double>(kPeriod_ns) /
         static_cast<double>(events_per_exposure);
}

std::vector<Event> makeEvents(const std::vector<std::vector<float>>& steps, SensorSize size,
                              double threshold, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::vector<double> reference;  // where the last event of each pixel was
  for (const float log : steps.front()) {
    reference.push_back(static_cast<double>(log) + threshold * (share(random) - 1.0 / 2.0));
  }
  std::vector<Event> events;
  constexpr std::int64_t kStep_ns = kPeriod_ns / kSteps;
  for (std::size_t step = 1; step < steps.size(); ++step) {
    const std::size_t first = events.size();
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const auto before = static_cast<double>(steps[step - 1][i]);
      const auto after = static_cast<double>(steps[step][i]);
      while (std::abs(after - reference[i]) >= threshold) {
        const bool on = after > reference[i];
        reference[i] += on ? threshold : -threshold;
        const double when = std::clamp((reference[i] - before) / (after - before), 0.0, 1.0);
        constexpr double kLatest = 0.999;  // before the next step
        Event event;
        event.x = static_cast<std::uint16_t>(i % static_cast<std::size_t>(size.width));
        event.y = static_cast<std::uint16_t>(i / static_cast<std::size_t>(size.width));
        event.on = on;
        event.t_ns = static_cast<std::int64_t>(step - 1) * kStep_ns +
                     static_cast<std::int64_t>(kLatest * when * static_cast<double>(kStep_ns));
        events.push_back(event);
      }
    }
    std::sort(events.begin() + static_cast<std::ptrdiff_t>(first), events.end(),
              [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
  }
  return events;
}

std::vector<std::uint8_t> expose(const std::vector<std::vector<float>>& steps,
                                 std::mt19937& random) {
  constexpr double kGrey_dn = 90.0, kNoise_dn = 1.5, kWhite_dn = 255.0;
  const auto step_at = [](std::int64_t t_ns) {
    return static_cast<std::size_t>(t_ns * kSteps / kPeriod_ns);
  };
  const std::size_t first = step_at(kExposureOffset_ns);
  const std::size_t last = step_at(kExposureOffset_ns + kExposure_ns);
  std::normal_distribution<double> noise(0.0, kNoise_dn);
  std::vector<std::uint8_t> frame;
  for (std::size_t i = 0; i < steps.front().size(); ++i) {
    double light = 0.0;
    for (std::size_t step = first; step <= last; ++step) {
      light += std::exp(static_cast<double>(steps[step][i]));
    }
    const double level = kGrey_dn * light / static_cast<double>(last - first + 1) + noise(random);
    frame.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, kWhite_dn))));
  }
  return frame;
}

}  // namespace

MovingTexture moveTexture(SensorSize size, std::size_t events_per_exposure, double path_px) {
  std::mt19937 random(kSeed);
  const std::vector<std::vector<float>> steps = render(size, path_px, makeWaves(random));
  const double threshold = thresholdFor(steps, events_per_exposure);
  MovingTexture texture;
  texture.thresholds = {threshold, threshold};
  texture.events = makeEvents(steps, size, threshold, random);
  texture.frame = expose(steps, random);
  return texture;
}

}  // namespace fast_edi::benchmarks
