/// \file
/// A simulated DAVIS moving before a textured plane or through a room: events, blurry frames and
/// the truth about both; in the room also an inertial sensor and true poses.
///
/// The scene is rendered at sub-steps that follow the motion (SimulationSettings::max_step_px). The
/// same renderings drive the events and are summed, by the trapezoidal rule, into the frame: it is
/// the integral over its half-open exposure interval [start, end).
///
/// Equal settings give equal output, bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/base/types.hpp"
#include "scenes/room_trajectory.hpp"
#include "scenes/simulation_settings.hpp"
#include "scenes/world.hpp"
#include "simulation/event_sensor.hpp"
#include "simulation/frame_sensor.hpp"
#include "simulation/imu_sensor.hpp"

namespace fast_edi {

struct SimulatedFrame {
  ExposureInterval exposure;      ///< multiples of 1 us
  cv::Mat blurry;                 ///< as the camera delivers it: CV_8UC1 or CV_16UC1
  cv::Mat sharp;                  ///< truth at mid-exposure, free of noise, same type
  std::vector<int> visible_tags;  ///< ids of tags wholly in view at mid-exposure
  std::optional<RigidPose> pose;  ///< of the camera at mid-exposure; in the room alone
};

/// A stretch of the recording: the exposure of one frame and the time until the next one begins.
struct SimulatedInterval {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  /// Sorted, with start < t <= end before rounding down to the clock, both later by the sensor's
  /// delay.
  std::vector<Event> events;
  std::vector<ImuSample> imu;  ///< with start <= t <= end, none twice; in the room alone
  SimulatedFrame frame;
};

struct SimulatedSequence {
  std::vector<Event> events;
  std::vector<SimulatedFrame> frames;
};

class DavisSimulator {
 public:
  /// \throws std::invalid_argument for settings out of range, std::runtime_error when the texture
  ///         file cannot be read
  explicit DavisSimulator(const SimulationSettings& settings);

  /// Simulates the next interval. \return false when all frames have been taken
  bool next(SimulatedInterval& interval);

  /// Irradiance of every pixel at an instant of sensor time, CV_32FC1, 1 = white at illumination 1.
  cv::Mat1f irradianceAt(std::int64_t t_ns) const;
  /// The latent image at an instant of sensor time: what a noise-free frame of vanishing exposure
  /// time and equal DN would show. CV_8UC1 or CV_16UC1.
  cv::Mat latentAt(std::int64_t t_ns) const;
  /// Ids of the tags that are wholly in view at an instant of sensor time.
  std::vector<int> visibleTagsAt(std::int64_t t_ns) const;

  const SimulationSettings& settings() const { return settings_; }
  /// The camera's way through the room; null before the plane.
  const RoomTrajectory* trajectory() const { return world_->trajectory(); }
  /// For the true thresholds.
  const EventSensor& eventSensor() const { return event_sensor_; }

 private:
  std::int64_t stepEnd(std::int64_t limit_ns) const;
  void advanceTo(std::int64_t t_ns, std::vector<Event>& events, cv::Mat1d* light_sum);

  SimulationSettings settings_;
  std::unique_ptr<const World> world_;
  EventSensor event_sensor_;
  FrameSensor frame_sensor_;
  ImuSensor imu_sensor_;
  int frames_taken_ = 0;
  std::int64_t t_ns_ = 0;
  cv::Mat1f irradiance_;       ///< at t_ns_
  cv::Mat1f next_irradiance_;  ///< scratch
};

/// Runs a whole simulation.
SimulatedSequence simulateSequence(const SimulationSettings& settings);

}  // namespace fast_edi
