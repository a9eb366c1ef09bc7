#include "simulation/davis_simulator.hpp"

#include <algorithm>
#include <cmath>

namespace fast_edi {
namespace {

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
      world_(makeWorld(settings)),
      event_sensor_(settings.sensor, settings.seed),
      frame_sensor_(settings.sensor, settings.seed),
      imu_sensor_(settings.imu, settings.timing.start_ns, settings.seed),
      t_ns_(settings.timing.start_ns) {
  world_->render(t_ns_, irradiance_);
  event_sensor_.begin(t_ns_, irradiance_);
}

std::int64_t DavisSimulator::stepEnd(std::int64_t limit_ns) const {
  std::int64_t step = std::min(
      {microseconds(settings_.max_step_us), event_sensor_.maxStepNs(), world_->maxStepNs()});
  const double speed = world_->speedPxPerSecond(t_ns_);
  if (speed > 0.0) {
    step = static_cast<std::int64_t>(
        std::min(static_cast<double>(step),
                 settings_.max_step_px / speed * static_cast<double>(kNanosecondsPerSecond)));
  }
  // The speed may rise within the step.
  while (step > kNanosecondsPerMicrosecond &&
         world_->displacementPx(t_ns_, t_ns_ + step) > settings_.max_step_px) {
    step = step * 3 / 4;
  }
  step = std::max(kNanosecondsPerMicrosecond, step - step % kNanosecondsPerMicrosecond);
  return std::min(limit_ns, t_ns_ + step);
}

void DavisSimulator::advanceTo(std::int64_t t_ns, std::vector<Event>& events,
                               cv::Mat1d* light_sum) {
  while (t_ns_ < t_ns) {
    const std::int64_t next = stepEnd(t_ns);
    world_->render(next, next_irradiance_);
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
  interval.imu.clear();
  interval.start_ns = t_ns_;
  const std::int64_t exposure_start = timing.start_ns + microseconds(timing.lead_us) +
                                      frames_taken_ * microseconds(timing.period_us);
  ++frames_taken_;
  const bool last = frames_taken_ == timing.frames;
  interval.end_ns =
      exposure_start + microseconds(timing.period_us) + (last ? microseconds(timing.lead_us) : 0);

  SimulatedFrame& frame = interval.frame;
  frame.exposure = {exposure_start,
                    exposure_start + microseconds(timing.exposureUs(frames_taken_ - 1))};
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
  if (const RoomTrajectory* way = trajectory()) {
    frame.pose = way->poseAt(middle - timing.start_ns);
    imu_sensor_.advance(interval.end_ns, *way, interval.imu);
  }
  return true;
}

cv::Mat1f DavisSimulator::irradianceAt(std::int64_t t_ns) const {
  cv::Mat1f irradiance;
  world_->render(t_ns, irradiance);
  return irradiance;
}

cv::Mat DavisSimulator::latentAt(std::int64_t t_ns) const {
  return frame_sensor_.noiseFree(irradianceAt(t_ns));
}

std::vector<int> DavisSimulator::visibleTagsAt(std::int64_t t_ns) const {
  return world_->visibleTagsAt(t_ns);
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
