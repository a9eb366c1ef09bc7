#include "fast_edi/simulation/davis_simulator.hpp"

#include <algorithm>
#include <cmath>

namespace fast_edi {
namespace {

/// Longest time between two renderings, so that leak and noise keep their order in a still scene.
constexpr std::int64_t kMaxStepNs = kNanosecondsPerMillisecond;
/// Renderings per period of a flickering light.
constexpr double kStepsPerFlicker = 40.0;

const SimulationSettings& validated(const SimulationSettings& settings) {
  settings.validate();
  return settings;
}

std::int64_t microseconds(std::int64_t us) {
  return us * kNanosecondsPerMicrosecond;
}

}  // namespace

DavisSimulator::DavisSimulator(const SimulationSettings& settings)
    : settings_(validated(settings)),
      scene_(settings.scene, settings.sensor.size, settings.sensor.color_filter, settings.seed),
      motion_(settings.motion, settings.sensor.size, settings.focalLengthPx(), settings.seed),
      event_sensor_(settings.sensor, settings.seed),
      frame_sensor_(settings.sensor, settings.seed),
      t_ns_(settings.timing.start_ns) {
  renderAt(t_ns_, irradiance_);
  event_sensor_.begin(t_ns_, irradiance_);
}

void DavisSimulator::renderAt(std::int64_t t_ns, cv::Mat1f& irradiance) const {
  scene_.render(motion_.imageToPlaneAt(t_ns - settings_.timing.start_ns), t_ns, irradiance);
}

std::int64_t DavisSimulator::stepEnd(std::int64_t limit_ns) const {
  const std::int64_t now = t_ns_ - settings_.timing.start_ns;
  std::int64_t step = std::min(kMaxStepNs, event_sensor_.maxStepNs());
  if (settings_.scene.flicker_hz > 0.0) {
    step =
        std::min(step, static_cast<std::int64_t>(static_cast<double>(kNanosecondsPerSecond) /
                                                 (kStepsPerFlicker * settings_.scene.flicker_hz)));
  }
  const double speed = motion_.speedPxPerSecond(now);
  if (speed > 0.0) {
    step = static_cast<std::int64_t>(
        std::min(static_cast<double>(step),
                 settings_.max_step_px / speed * static_cast<double>(kNanosecondsPerSecond)));
  }
  // The speed may rise within the step.
  while (step > kNanosecondsPerMicrosecond &&
         motion_.displacementPx(now, now + step) > settings_.max_step_px) {
    step = step * 3 / 4;
  }
  step = std::max(kNanosecondsPerMicrosecond, step - step % kNanosecondsPerMicrosecond);
  return std::min(limit_ns, t_ns_ + step);
}

void DavisSimulator::advanceTo(std::int64_t t_ns, std::vector<Event>& events,
                               cv::Mat1d* light_sum) {
  while (t_ns_ < t_ns) {
    const std::int64_t next = stepEnd(t_ns);
    renderAt(next, next_irradiance_);
    event_sensor_.advance(next, next_irradiance_, events);
    if (light_sum != nullptr) {
      const double half_step = 0.5 * static_cast<double>(next - t_ns_);
      double* sum = (*light_sum)[0];
      const float* before = irradiance_[0];
      const float* after = next_irradiance_[0];
      const std::size_t pixels = light_sum->total();
      for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        sum[pixel] += half_step * (static_cast<double>(before[pixel]) + after[pixel]);
      }
    }
    cv::swap(irradiance_, next_irradiance_);
    t_ns_ = next;
  }
}

bool DavisSimulator::next(SimulatedInterval& interval) {
  const TimingSettings& timing = settings_.timing;
  if (frames_taken_ >= timing.frames) return false;
  interval.events.clear();
  interval.start_ns = t_ns_;
  const std::int64_t exposure_start = timing.start_ns + microseconds(timing.lead_us) +
                                      frames_taken_ * microseconds(timing.period_us);
  ++frames_taken_;
  const bool last = frames_taken_ == timing.frames;
  interval.end_ns =
      exposure_start + microseconds(timing.period_us) + (last ? microseconds(timing.lead_us) : 0);

  SimulatedFrame& frame = interval.frame;
  frame.exposure = {exposure_start, exposure_start + microseconds(timing.exposure_us)};
  advanceTo(frame.exposure.start_ns, interval.events, nullptr);
  cv::Mat1d light_sum = cv::Mat1d::zeros(settings_.sensor.size.height, settings_.sensor.size.width);
  advanceTo(frame.exposure.end_ns, interval.events, &light_sum);
  cv::Mat1f mean;
  light_sum.convertTo(mean, CV_32F, 1.0 / static_cast<double>(frame.exposure.length()));
  frame.blurry = frame_sensor_.expose(mean);
  const std::int64_t middle = frame.exposure.at(ExposureInstant::kMid);
  frame.sharp = latentAt(middle);
  frame.visible_tags = visibleTagsAt(middle);
  advanceTo(interval.end_ns, interval.events, nullptr);
  return true;
}

cv::Mat1f DavisSimulator::irradianceAt(std::int64_t t_ns) const {
  cv::Mat1f irradiance;
  renderAt(t_ns, irradiance);
  return irradiance;
}

cv::Mat DavisSimulator::latentAt(std::int64_t t_ns) const {
  return frame_sensor_.noiseFree(irradianceAt(t_ns));
}

std::vector<int> DavisSimulator::visibleTagsAt(std::int64_t t_ns) const {
  const cv::Matx33d plane_to_image = motion_.imageToPlaneAt(t_ns - settings_.timing.start_ns).inv();
  const double right = settings_.sensor.size.width - 1;
  const double bottom = settings_.sensor.size.height - 1;
  std::vector<int> visible;
  for (const PlacedTag& tag : scene_.tags()) {
    const std::array<cv::Point2d, 4> corners = tag.corners(kTagPaperFactor);
    const bool inside = std::all_of(corners.begin(), corners.end(), [&](const cv::Point2d& corner) {
      const cv::Vec3d p = plane_to_image * cv::Vec3d(corner.x, corner.y, 1.0);
      const double x = p[0] / p[2];
      const double y = p[1] / p[2];
      return x >= 0.0 && x <= right && y >= 0.0 && y <= bottom;
    });
    if (inside) visible.push_back(tag.id);
  }
  return visible;
}

SimulatedSequence simulateSequence(const SimulationSettings& settings) {
  DavisSimulator simulator(settings);
  SimulatedSequence sequence;
  SimulatedInterval interval;
  while (simulator.next(interval)) {
    sequence.events.insert(sequence.events.end(), interval.events.begin(), interval.events.end());
    sequence.frames.push_back(interval.frame);
  }
  return sequence;
}

}  // namespace fast_edi
