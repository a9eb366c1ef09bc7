// The event pixel against hand-made irradiance, where every event can be foretold.
#include "simulation/event_sensor.hpp"

#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kStart = 5 * kNanosecondsPerSecond;
constexpr SensorSize kSize{40, 30};

SensorSettings idealSettings() {
  SensorSettings settings = SensorSettings::ideal();
  settings.size = kSize;
  settings.thresholds = {0.2, 0.3};
  return settings;
}

cv::Mat1f uniformIrradiance(double log_irradiance) {
  return cv::Mat1f(kSize.height, kSize.width, static_cast<float>(std::exp(log_irradiance)));
}

/// Steps of 1 ms with constant irradiance.
std::vector<Event> still(EventSensor& sensor, double log_irradiance, int milliseconds) {
  std::vector<Event> events;
  sensor.begin(kStart, uniformIrradiance(log_irradiance));
  for (int ms = 1; ms <= milliseconds; ++ms) {
    sensor.advance(kStart + ms * kNanosecondsPerMillisecond, uniformIrradiance(log_irradiance),
                   events);
  }
  return events;
}

std::vector<Event> ofPixel(const std::vector<Event>& events, int x, int y) {
  std::vector<Event> own;
  for (const Event& event : events) {
    if (event.x == x && event.y == y) own.push_back(event);
  }
  return own;
}

std::vector<double> timesMs(const std::vector<Event>& events) {
  std::vector<double> times;
  for (const Event& event : events) {
    times.push_back(static_cast<double>(event.t_ns - kStart) * 1e-6);
  }
  return times;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(const std::vector<float>& values) {
  const double centre = mean(values);
  double sum = 0.0;
  for (const float value : values) sum += (value - centre) * (value - centre);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(EventSensorTest, FiresWhenARisingSignalCrossesEachThreshold) {
  EventSensor sensor(idealSettings(), 1);
  std::vector<Event> events;
  sensor.begin(kStart, uniformIrradiance(-1.0));
  // 1.0 in 10 ms: a threshold of 0.2 every 2 ms; short of the fifth.
  sensor.advance(kStart + 10 * kNanosecondsPerMillisecond, uniformIrradiance(-0.001), events);
  const std::vector<Event> own = ofPixel(events, 3, 4);
  ASSERT_EQ(own.size(), 4U);
  EXPECT_THAT(timesMs(own), testing::Pointwise(testing::DoubleNear(0.01), {2.0, 4.0, 6.0, 8.0}));
  for (const Event& event : own) EXPECT_TRUE(event.on);
  EXPECT_EQ(events.size(), 4U * kSize.pixelCount());
}

TEST(EventSensorTest, FallingSignalUsesTheOffThreshold) {
  EventSensor sensor(idealSettings(), 1);
  std::vector<Event> events;
  sensor.begin(kStart, uniformIrradiance(0.0));
  sensor.advance(kStart + 10 * kNanosecondsPerMillisecond, uniformIrradiance(-1.0), events);
  const std::vector<Event> own = ofPixel(events, 0, 0);
  ASSERT_EQ(own.size(), 3U);
  EXPECT_THAT(timesMs(own), testing::Pointwise(testing::DoubleNear(0.01), {3.0, 6.0, 9.0}));
  for (const Event& event : own) EXPECT_FALSE(event.on);
}

TEST(EventSensorTest, LevelsCarryOverFromStepToStep) {
  EventSensor sensor(idealSettings(), 1);
  std::vector<Event> events;
  sensor.begin(kStart, uniformIrradiance(0.0));
  for (int ms = 1; ms <= 10; ++ms) {
    sensor.advance(kStart + ms * kNanosecondsPerMillisecond, uniformIrradiance(0.0999 * ms),
                   events);
  }
  EXPECT_EQ(ofPixel(events, 7, 7).size(), 4U);
}

TEST(EventSensorTest, StillSceneIsSilentWithoutNoise) {
  EventSensor sensor(idealSettings(), 1);
  EXPECT_TRUE(still(sensor, -1.0, 100).empty());
}

TEST(EventSensorTest, TimesAreSortedMultiplesOfTheClock) {
  SensorSettings settings;  // with all usual noise
  settings.size = kSize;
  settings.shot_noise_dark_hz = 500.0;
  for (const std::int64_t clock_us : {1, 50}) {
    settings.clock_us = clock_us;
    EventSensor sensor(settings, 3);
    std::vector<Event> events;
    sensor.begin(kStart, uniformIrradiance(-1.0));
    for (int ms = 1; ms <= 20; ++ms) {
      sensor.advance(kStart + ms * 333'333, uniformIrradiance(std::sin(0.5 * ms)), events);
    }
    ASSERT_GT(events.size(), 1000U);
    for (std::size_t i = 0; i < events.size(); ++i) {
      EXPECT_EQ(events[i].t_ns % (clock_us * kNanosecondsPerMicrosecond), 0);
      if (i > 0) {
        ASSERT_GE(events[i].t_ns, events[i - 1].t_ns);
      }
    }
  }
}

TEST(EventSensorTest, RefractoryPeriodIsKeptAndSwallowsChange) {
  SensorSettings settings = idealSettings();
  settings.refractory_ns = 500'000;
  EventSensor sensor(settings, 1);
  std::vector<Event> events;
  sensor.begin(kStart, uniformIrradiance(-2.0));
  // 2.0 in 10 ms: 0.2 per ms. Each event costs 1 ms to the threshold and 0.5 ms of reset in which
  // 0.1 is lost; a seventh would come at 10 ms.
  sensor.advance(kStart + 9'900'000, uniformIrradiance(-0.02), events);
  const std::vector<Event> own = ofPixel(events, 1, 2);
  EXPECT_THAT(timesMs(own),
              testing::Pointwise(testing::DoubleNear(0.01), {1.0, 2.5, 4.0, 5.5, 7.0, 8.5}));
}

TEST(EventSensorTest, RefractoryPeriodReachesAcrossStepsAndNoise) {
  SensorSettings settings;
  settings.size = kSize;
  settings.refractory_ns = 700'000;
  settings.shot_noise_bright_hz = settings.shot_noise_dark_hz = 400.0;
  EventSensor sensor(settings, 5);
  std::vector<Event> events;
  sensor.begin(kStart, uniformIrradiance(0.0));
  for (int step = 1; step <= 200; ++step) {
    sensor.advance(kStart + step * 250'000, uniformIrradiance(std::sin(0.2 * step)), events);
  }
  std::map<std::pair<int, int>, std::int64_t> last;
  std::size_t pairs = 0;
  for (const Event& event : events) {
    const std::pair<int, int> pixel(event.x, event.y);
    const auto it = last.find(pixel);
    if (it != last.end()) {
      // Both times are rounded down to 1 us.
      ASSERT_GE(event.t_ns - it->second, settings.refractory_ns - kNanosecondsPerMicrosecond);
      ++pairs;
    }
    last[pixel] = event.t_ns;
  }
  EXPECT_GT(pairs, 5000U);
}

TEST(EventSensorTest, LeakGivesOnEventsAtItsRate) {
  SensorSettings settings = idealSettings();
  settings.leak_rate_hz = 10.0;
  settings.random_initial_level = true;
  EventSensor sensor(settings, 2);
  const std::vector<Event> events = still(sensor, -1.0, 1000);
  for (const Event& event : events) ASSERT_TRUE(event.on);
  // The initial level is spread over both thresholds, so that the first event of a pixel comes
  // after 1.25 periods in the mean: it lies 0.25 (off, 0.3) to 0 (on, 0.2) of the way.
  const double expected =
      (10.0 - (0.5 * (0.2 + 0.3) / 0.2 - 0.5)) * static_cast<double>(kSize.pixelCount());
  EXPECT_NEAR(static_cast<double>(events.size()), expected, 0.01 * expected);
}

TEST(EventSensorTest, HotPixelsFireAtTheirRate) {
  SensorSettings settings = idealSettings();
  settings.hot_pixel_fraction = 0.02;
  settings.hot_pixel_rate_hz = 2000.0;
  EventSensor sensor(settings, 2);
  const std::vector<Event> events = still(sensor, -1.0, 50);
  std::map<std::pair<int, int>, int> counts;
  for (const Event& event : events) ++counts[{event.x, event.y}];
  // Binomial with n = 1200, p = 0.02: 24 +- 4.8.
  EXPECT_GT(counts.size(), 9U);
  EXPECT_LT(counts.size(), 39U);
  for (const auto& entry : counts) EXPECT_NEAR(entry.second, 100, 1);
}

/// Pixels that fired in 50 ms of a still scene with some hot pixels in a given shape.
std::set<std::pair<int, int>> hotPixels(HotPixelShape shape, double fraction) {
  SensorSettings settings = idealSettings();
  settings.hot_pixel_fraction = fraction;
  settings.hot_pixel_rate_hz = 2000.0;
  settings.hot_pixel_shape = shape;
  EventSensor sensor(settings, 2);
  std::set<std::pair<int, int>> hot;
  for (const Event& event : still(sensor, -1.0, 5)) hot.insert({event.x, event.y});
  return hot;
}

TEST(EventSensorTest, HotPixelsLieTogetherAsTheirShapeSays) {
  constexpr double kFraction = 0.02;
  const auto beside = [](const std::set<std::pair<int, int>>& hot, const std::pair<int, int>& pixel,
                         int dx, int dy) {
    return hot.count({pixel.first + dx, pixel.second + dy}) > 0;
  };
  const auto pairs = hotPixels(HotPixelShape::kPair, kFraction);
  const auto blocks = hotPixels(HotPixelShape::kBlock, kFraction);
  const auto rows = hotPixels(HotPixelShape::kRow, kFraction);
  for (const auto* hot : {&pairs, &blocks, &rows}) {
    EXPECT_GE(hot->size(), 4U);
    EXPECT_LE(hot->size(), 60U);  // 24 in the mean
  }
  // A shape is cut only by the right and lower border of the sensor.
  const auto inside = [](const std::pair<int, int>& pixel) {
    return pixel.first < kSize.width - 1 && pixel.second < kSize.height - 1;
  };
  for (const auto& pixel : pairs) {
    EXPECT_TRUE(!inside(pixel) || beside(pairs, pixel, 1, 0) || beside(pairs, pixel, -1, 0));
  }
  for (const auto& pixel : blocks) {
    EXPECT_TRUE(!inside(pixel) || beside(blocks, pixel, 1, 0) || beside(blocks, pixel, -1, 0));
    EXPECT_TRUE(!inside(pixel) || beside(blocks, pixel, 0, 1) || beside(blocks, pixel, 0, -1));
  }
  for (const auto& pixel : rows) {
    int length = 1;
    for (int dx = 1; beside(rows, pixel, dx, 0); ++dx) ++length;
    for (int dx = -1; beside(rows, pixel, dx, 0); --dx) ++length;
    EXPECT_TRUE(length >= 4 || pixel.first >= kSize.width - 3);
  }
}

TEST(EventSensorTest, AHotColumnIsHotFromTopToBottom) {
  const auto hot = hotPixels(HotPixelShape::kColumn, 3.0 / kSize.width);
  std::map<int, int> by_column;
  for (const auto& pixel : hot) ++by_column[pixel.first];
  EXPECT_GE(by_column.size(), 1U);
  EXPECT_LE(by_column.size(), 10U);
  for (const auto& [column, count] : by_column) {
    EXPECT_EQ(count, kSize.height) << "column " << column;
  }
}

TEST(EventSensorTest, DelayMakesTheSameEventsLate) {
  const auto rising = [](std::int64_t delay_us) {
    SensorSettings settings = idealSettings();
    settings.delay_us = delay_us;
    EventSensor sensor(settings, 1);
    std::vector<Event> events;
    sensor.begin(kStart, uniformIrradiance(-1.0));
    sensor.advance(kStart + 10 * kNanosecondsPerMillisecond, uniformIrradiance(0.0), events);
    return events;
  };
  const std::vector<Event> prompt = rising(0);
  const std::vector<Event> late = rising(5000);
  ASSERT_EQ(late.size(), prompt.size());
  for (std::size_t i = 0; i < late.size(); ++i) {
    ASSERT_EQ(late[i].t_ns - prompt[i].t_ns, 5 * kNanosecondsPerMillisecond);
    ASSERT_EQ(late[i].x, prompt[i].x);
  }
}

TEST(EventSensorTest, BelowItsLimitTheResponseIsLinear) {
  SensorSettings settings = idealSettings();
  settings.white_dn = 200.0;
  settings.linear_below_dn = 20.0;
  settings.thresholds = {0.1, 0.1};
  const auto count = [&](double from_dn, double to_dn) {
    EventSensor sensor(settings, 1);
    std::vector<Event> events;
    sensor.begin(kStart, uniformIrradiance(std::log(from_dn / settings.white_dn)));
    sensor.advance(kStart + 10 * kNanosecondsPerMillisecond,
                   uniformIrradiance(std::log(to_dn / settings.white_dn)), events);
    return ofPixel(events, 3, 3).size();
  };
  // ln(20) / 20 = 0.1498 for a DN: from 4 to 10 DN 0.899, where the log has 0.916.
  EXPECT_EQ(count(4.0, 10.0), 8U);
  // From 10 to 40 DN 10 x 0.1498 and ln(2): 2.191, where the log has 1.386.
  EXPECT_EQ(count(10.0, 40.0), 21U);
  EXPECT_EQ(count(40.0, 160.0), 13U);
}

TEST(EventSensorTest, ShotNoiseRateFollowsIrradiance) {
  SensorSettings settings = idealSettings();
  settings.shot_noise_bright_hz = 10.0;
  settings.shot_noise_dark_hz = 90.0;
  for (const double irradiance : {0.02, 0.5, 1.0}) {
    EventSensor sensor(settings, 4);
    const std::vector<Event> events = still(sensor, std::log(irradiance), 500);
    const double expected =
        0.5 * static_cast<double>(kSize.pixelCount()) * (90.0 - 80.0 * irradiance);
    const auto count = static_cast<double>(events.size());
    EXPECT_NEAR(count, expected, 4.0 * std::sqrt(expected)) << "irradiance " << irradiance;
    const auto on =
        std::count_if(events.begin(), events.end(), [](const Event& e) { return e.on; });
    EXPECT_NEAR(static_cast<double>(on), 0.5 * count, 2.0 * std::sqrt(count));
  }
}

TEST(EventSensorTest, MismatchHasTheMeanAndSpreadThatWasSet) {
  SensorSettings settings;
  settings.threshold_mismatch = 0.08;
  const EventSensor sensor(settings, 6);
  // 89960 pixels: standard error of the mean 0.03 %, of the deviation 0.24 %.
  EXPECT_NEAR(mean(sensor.thresholdsOn()) / settings.thresholds.on, 1.0, 0.0015);
  EXPECT_NEAR(mean(sensor.thresholdsOff()) / settings.thresholds.off, 1.0, 0.0015);
  EXPECT_NEAR(deviation(sensor.thresholdsOn()) / (0.08 * settings.thresholds.on), 1.0, 0.015);
  EXPECT_NEAR(deviation(sensor.thresholdsOff()) / (0.08 * settings.thresholds.off), 1.0, 0.015);
}

TEST(EventSensorTest, WithoutMismatchAllThresholdsAreEqual) {
  const EventSensor sensor(idealSettings(), 6);
  EXPECT_THAT(sensor.thresholdsOn(), testing::Each(testing::FloatEq(0.2F)));
  EXPECT_THAT(sensor.thresholdsOff(), testing::Each(testing::FloatEq(0.3F)));
}

TEST(EventSensorTest, PhotoreceptorFollowsAStepExponentially) {
  SensorSettings settings = idealSettings();
  settings.thresholds = {0.1, 0.1};
  settings.photoreceptor_bright_hz = settings.photoreceptor_dark_hz = 30.0;
  EventSensor sensor(settings, 1);
  const std::int64_t step_ns = sensor.maxStepNs() / 20;
  std::vector<Event> events;
  sensor.begin(kStart, uniformIrradiance(-1.0));
  for (int i = 1; i <= 400; ++i) {
    sensor.advance(kStart + i * step_ns, uniformIrradiance(0.0), events);
  }
  // The first step is a ramp of step_ns, taken as a jump in its middle.
  const double time_constant_ms = 1e3 / (2.0 * M_PI * 30.0);
  const std::vector<Event> own = ofPixel(events, 5, 5);
  ASSERT_EQ(own.size(), 9U);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const double expected_ms =
        -time_constant_ms * std::log(1.0 - 0.1 * (static_cast<double>(k) + 1)) +
        0.5e-6 * static_cast<double>(step_ns);
    EXPECT_NEAR(timesMs(own)[k], expected_ms, 0.02) << "event " << k;
  }
}

TEST(EventSensorTest, RefusesIrradianceOfAnotherSize) {
  EventSensor sensor(idealSettings(), 1);
  EXPECT_THROW(sensor.begin(kStart, cv::Mat1f::ones(30, 41)), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
