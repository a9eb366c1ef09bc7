#include "simulation/event_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/random/bernoulli_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

namespace fast_edi {
namespace {

/// Thresholds are not let below this part of the mean: a comparator with none would oscillate.
constexpr double kSmallestThreshold = 0.2;
constexpr std::int64_t kNotRefractory = 0;
/// A step resolves the low-pass when it is at most this part of its shortest time constant.
constexpr double kStepPerTimeConstant = 0.5;

std::vector<float> drawThresholds(double mean, double mismatch, std::size_t count,
                                  RandomEngine& random) {
  boost::random::normal_distribution<double> normal(1.0, mismatch);
  std::vector<float> thresholds(count, static_cast<float>(mean));
  if (mismatch > 0.0) {
    for (float& threshold : thresholds) {
      threshold = static_cast<float>(mean * std::max(kSmallestThreshold, normal(random)));
    }
  }
  return thresholds;
}

/// Linear between its values at irradiance 0 and 1, constant beyond.
double byIrradiance(double dark, double bright, float irradiance) {
  return dark + (bright - dark) * std::min(1.0, static_cast<double>(irradiance));
}

cv::Size hotPixelExtent(HotPixelShape shape, int sensor_height) {
  switch (shape) {
    case HotPixelShape::kSingle:
      return {1, 1};
    case HotPixelShape::kPair:
      return {2, 1};
    case HotPixelShape::kBlock:
      return {2, 2};
    case HotPixelShape::kRow:
      return {4, 1};
    case HotPixelShape::kColumn:
      return {1, sensor_height};
  }
  return {1, 1};
}

double seconds(double ns) {
  return ns / static_cast<double>(kNanosecondsPerSecond);
}

}  // namespace

/// The signal of a step: log irradiance of a pixel goes from `log` to `next` over `length_ns`.
struct EventSensor::Step {
  std::int64_t start_ns;
  double length_ns;
  const float* log;
  const float* next;

  double at(std::size_t pixel, double t_ns) const {
    const double from = log[pixel];
    return from + (static_cast<double>(next[pixel]) - from) * (t_ns / length_ns);
  }
};

EventSensor::EventSensor(const SensorSettings& settings, std::uint64_t seed)
    : settings_(settings),
      noise_random_(makeRandomEngine(seed, RandomStream::kShotNoise)),
      initial_random_(makeRandomEngine(seed, RandomStream::kInitialLevels)) {
  const std::size_t pixels = settings.size.pixelCount();
  RandomEngine random = makeRandomEngine(seed, RandomStream::kThresholds);
  on_ = drawThresholds(settings.thresholds.on, settings.threshold_mismatch, pixels, random);
  off_ = drawThresholds(settings.thresholds.off, settings.threshold_mismatch, pixels, random);
  drawHotPixels(seed);
}

void EventSensor::drawHotPixels(std::uint64_t seed) {
  const std::size_t pixels = settings_.size.pixelCount();
  const int width = settings_.size.width;
  const cv::Size extent = hotPixelExtent(settings_.hot_pixel_shape, settings_.size.height);
  RandomEngine random = makeRandomEngine(seed, RandomStream::kHotPixels);
  boost::random::bernoulli_distribution<double> starts_one(settings_.hot_pixel_fraction /
                                                           extent.area());
  std::vector<bool> hot(pixels, false);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    if (!starts_one(random)) continue;
    const cv::Rect sensor(0, 0, width, settings_.size.height);
    // A column is drawn once for each of its pixels: any of them marks all of it.
    const int y = static_cast<int>(pixel) / width;
    const cv::Point corner(static_cast<int>(pixel) % width,
                           settings_.hot_pixel_shape == HotPixelShape::kColumn ? 0 : y);
    const cv::Rect place = cv::Rect(corner, extent) & sensor;
    for (int row = place.y; row < place.br().y; ++row) {
      for (int column = place.x; column < place.br().x; ++column) {
        hot[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(column)] = true;
      }
    }
  }
  leak_.resize(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const double rate_hz = hot[pixel] ? settings_.hot_pixel_rate_hz : settings_.leak_rate_hz;
    leak_[pixel] = static_cast<float>(rate_hz * on_[pixel]);
  }
}

void EventSensor::respond(const cv::Mat1f& irradiance, cv::Mat1f& log) const {
  cv::log(irradiance, log);
  const double below_dn = settings_.linear_below_dn;
  if (below_dn <= 0.0) return;
  const auto below = static_cast<float>(below_dn / settings_.white_dn);
  const double slope = settings_.white_dn * std::log(below_dn) / below_dn;
  const double offset = std::log(settings_.white_dn);  // the log is that of irradiance, not of DN
  for (int y = 0; y < log.rows; ++y) {
    for (int x = 0; x < log.cols; ++x) {
      const float light = irradiance(y, x);
      if (light < below) log(y, x) = static_cast<float>(slope * light - offset);
    }
  }
}

void EventSensor::begin(std::int64_t t_ns, const cv::Mat1f& irradiance) {
  const std::size_t pixels = settings_.size.pixelCount();
  if (irradiance.rows != settings_.size.height || irradiance.cols != settings_.size.width) {
    throw std::invalid_argument("EventSensor: irradiance is not of the sensor's size");
  }
  t_ns_ = t_ns;
  respond(irradiance, log_);
  log_.copyTo(input_log_);
  next_log_.create(log_.size());
  free_ns_.assign(pixels, kNotRefractory);
  level_.resize(pixels);
  boost::random::uniform_real_distribution<double> unit(0.0, 1.0);
  const float* log = log_[0];
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    level_[pixel] = log[pixel];
    if (settings_.random_initial_level) {
      // The pixel has already moved part of the way to one of its thresholds.
      const double span = static_cast<double>(on_[pixel]) + off_[pixel];
      level_[pixel] += off_[pixel] - span * unit(initial_random_);
    }
  }
}

std::int64_t EventSensor::maxStepNs() const {
  const double fastest_hz =
      std::max(settings_.photoreceptor_bright_hz, settings_.photoreceptor_dark_hz);
  if (fastest_hz <= 0.0) return kNanosecondsPerSecond;
  const double time_constant_s = 1.0 / (2.0 * CV_PI * fastest_hz);
  return std::max(kNanosecondsPerMicrosecond,
                  static_cast<std::int64_t>(kStepPerTimeConstant * time_constant_s *
                                            static_cast<double>(kNanosecondsPerSecond)));
}

void EventSensor::filterPhotoreceptor(const cv::Mat1f& irradiance, double dt_s) {
  // Exact for an input x that is linear over the step, with slope m and time constant T:
  // y(dt) = x(dt) - m T + (y(0) - x(0) + m T) exp(-dt / T).
  cv::Mat1f input;
  respond(irradiance, input);
  const std::size_t pixels = settings_.size.pixelCount();
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const double cutoff_hz = byIrradiance(settings_.photoreceptor_dark_hz,
                                          settings_.photoreceptor_bright_hz, irradiance[0][pixel]);
    const double rate = 2.0 * CV_PI * cutoff_hz;
    const double x0 = input_log_[0][pixel];
    const double x1 = input[0][pixel];
    const double lag = (x1 - x0) / (dt_s * rate);
    next_log_[0][pixel] =
        static_cast<float>(x1 - lag + (log_[0][pixel] - x0 + lag) * std::exp(-dt_s * rate));
  }
  cv::swap(input, input_log_);
}

void EventSensor::drawNoise(const cv::Mat1f& irradiance, double length_ns) {
  // Poisson process of the highest rate over the whole array, thinned by each pixel's own rate.
  noise_.clear();
  const double highest_hz = std::max(settings_.shot_noise_bright_hz, settings_.shot_noise_dark_hz);
  const std::size_t pixels = settings_.size.pixelCount();
  const double mean = highest_hz * static_cast<double>(pixels) * seconds(length_ns);
  if (mean <= 0.0) return;
  const int count = boost::random::poisson_distribution<int, double>(mean)(noise_random_);
  boost::random::uniform_int_distribution<std::uint32_t> any_pixel(
      0, static_cast<std::uint32_t>(pixels - 1));
  boost::random::uniform_real_distribution<double> unit(0.0, 1.0);
  boost::random::bernoulli_distribution<double> coin(0.5);
  for (int i = 0; i < count; ++i) {
    NoiseEvent noise{};
    noise.pixel = any_pixel(noise_random_);
    noise.t_ns = length_ns * unit(noise_random_);
    noise.on = coin(noise_random_);
    const double rate_hz = byIrradiance(settings_.shot_noise_dark_hz,
                                        settings_.shot_noise_bright_hz, irradiance[0][noise.pixel]);
    if (unit(noise_random_) * highest_hz < rate_hz) noise_.push_back(noise);
  }
  std::sort(noise_.begin(), noise_.end(), [](const NoiseEvent& a, const NoiseEvent& b) {
    return a.pixel != b.pixel ? a.pixel < b.pixel : a.t_ns < b.t_ns;
  });
}

void EventSensor::fire(std::size_t pixel, const Step& step, double at_ns, bool on,
                       std::vector<Event>& events) {
  // The step's end rounds up never: at_ns <= length_ns, whole nanoseconds, then the clock.
  const std::int64_t exact_ns = step.start_ns + static_cast<std::int64_t>(at_ns);
  Event event;
  event.x = static_cast<std::uint16_t>(pixel % static_cast<std::size_t>(settings_.size.width));
  event.y = static_cast<std::uint16_t>(pixel / static_cast<std::size_t>(settings_.size.width));
  const std::int64_t late_ns = exact_ns + settings_.delay_us * kNanosecondsPerMicrosecond;
  event.t_ns = late_ns - late_ns % (settings_.clock_us * kNanosecondsPerMicrosecond);
  event.on = on;
  events.push_back(event);
  if (settings_.refractory_ns > 0) free_ns_[pixel] = exact_ns + settings_.refractory_ns;
}

void EventSensor::advancePixel(std::size_t pixel, const Step& step, double from_ns, double to_ns,
                               std::vector<Event>& events) {
  double& level = level_[pixel];
  const double leak_per_ns = seconds(leak_[pixel]);
  double t = from_ns;
  while (true) {
    if (free_ns_[pixel] != kNotRefractory) {
      const double free = static_cast<double>(free_ns_[pixel] - step.start_ns);
      if (free >= to_ns) return;
      t = std::max(t, free);
      level = step.at(pixel, t);
      free_ns_[pixel] = kNotRefractory;
    }
    // Difference between signal and level: linear in time, the level's leak included.
    const double now = step.at(pixel, t) - level;
    const double then = step.at(pixel, to_ns) - level + leak_per_ns * (to_ns - t);
    const bool on = then > now;
    const double threshold = on ? on_[pixel] : -static_cast<double>(off_[pixel]);
    if (on ? then < threshold : then > threshold) {
      level -= leak_per_ns * (to_ns - t);
      return;
    }
    // A random initial level may lie a rounding error beyond the threshold.
    const double part = then != now ? std::clamp((threshold - now) / (then - now), 0.0, 1.0) : 0.0;
    const double crossing = t + part * (to_ns - t);
    level += threshold - leak_per_ns * (crossing - t);
    t = crossing;
    fire(pixel, step, crossing, on, events);
  }
}

void EventSensor::advance(std::int64_t t_ns, const cv::Mat1f& irradiance,
                          std::vector<Event>& events) {
  const auto length_ns = static_cast<double>(t_ns - t_ns_);
  if (settings_.photoreceptor_bright_hz > 0.0) {
    filterPhotoreceptor(irradiance, seconds(length_ns));
  } else {
    respond(irradiance, next_log_);
  }
  drawNoise(irradiance, length_ns);

  const Step step{t_ns_, length_ns, log_[0], next_log_[0]};
  const std::size_t first = events.size();
  const double leak_s = seconds(length_ns);
  const std::size_t pixels = settings_.size.pixelCount();
  auto noise = noise_.cbegin();
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const bool noisy = noise != noise_.cend() && noise->pixel == pixel;
    if (!noisy && free_ns_[pixel] == kNotRefractory) {
      // Most pixels: neither threshold is reached.
      const double then = step.next[pixel] - level_[pixel] + leak_[pixel] * leak_s;
      if (then < on_[pixel] && then > -off_[pixel]) {
        level_[pixel] -= leak_[pixel] * leak_s;
        continue;
      }
    }
    double t = 0.0;
    for (; noise != noise_.cend() && noise->pixel == pixel; ++noise) {
      advancePixel(pixel, step, t, noise->t_ns, events);
      t = noise->t_ns;
      if (free_ns_[pixel] != kNotRefractory) continue;  // still refractory
      level_[pixel] = step.at(pixel, t);
      fire(pixel, step, t, noise->on, events);
    }
    advancePixel(pixel, step, t, length_ns, events);
  }
  std::stable_sort(events.begin() + static_cast<std::ptrdiff_t>(first), events.end(),
                   [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
  cv::swap(log_, next_log_);
  t_ns_ = t_ns;
}

}  // namespace fast_edi
