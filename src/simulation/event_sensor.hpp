/// \file
/// The event part of the simulated pixel array.
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/base/types.hpp"
#include "scenes/random.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Turns irradiance given at successive instants into events. Between two instants log irradiance
/// is taken as linear, so that crossing times are exact for that signal; they are then rounded down
/// to the sensor's clock (1 us unless set otherwise), and late by SensorSettings::delay_us.
///
/// Invariant (no noise, leak, refractory period or low-pass): at each instant given, log irradiance
/// minus the pixel's initial level minus the sum of its events' thresholds lies within
/// (-off, on) of that pixel.
class EventSensor {
 public:
  EventSensor(const SensorSettings& settings, std::uint64_t seed);

  /// Sets the instant at which the recording begins.
  /// \param irradiance CV_32FC1 of the sensor's size, > 0
  void begin(std::int64_t t_ns, const cv::Mat1f& irradiance);

  /// Appends the events of (last instant, t_ns], both later by the delay, sorted by time, equal
  /// times in row-major order. \pre begin() was called; t_ns is later than the last instant
  void advance(std::int64_t t_ns, const cv::Mat1f& irradiance, std::vector<Event>& events);

  /// Longest step that resolves the photoreceptor's low-pass [ns].
  std::int64_t maxStepNs() const;

  /// True thresholds, row-major [natural log], both positive.
  const std::vector<float>& thresholdsOn() const { return on_; }
  const std::vector<float>& thresholdsOff() const { return off_; }

 private:
  struct NoiseEvent {
    std::uint32_t pixel;
    double t_ns;  ///< since the step's start
    bool on;
  };
  struct Step;

  void drawHotPixels(std::uint64_t seed);
  /// The pixel's response to irradiance, a log (see SensorSettings::linear_below_dn).
  void respond(const cv::Mat1f& irradiance, cv::Mat1f& log) const;
  void filterPhotoreceptor(const cv::Mat1f& irradiance, double dt_s);
  void drawNoise(const cv::Mat1f& irradiance, double length_ns);
  void advancePixel(std::size_t pixel, const Step& step, double from_ns, double to_ns,
                    std::vector<Event>& events);
  void fire(std::size_t pixel, const Step& step, double at_ns, bool on, std::vector<Event>& events);

  SensorSettings settings_;
  RandomEngine noise_random_;
  RandomEngine initial_random_;
  std::vector<float> on_;
  std::vector<float> off_;
  std::vector<float> leak_;            ///< rise of log irradiance against the level [1/s]
  std::vector<double> level_;          ///< memorised log irradiance
  std::vector<std::int64_t> free_ns_;  ///< end of the refractory period
  std::int64_t t_ns_ = 0;
  cv::Mat1f log_;        ///< log irradiance as the pixel sees it, at t_ns_
  cv::Mat1f next_log_;   ///< scratch: the same at the step's end
  cv::Mat1f input_log_;  ///< before the photoreceptor, at t_ns_; low-pass only
  std::vector<NoiseEvent> noise_;
};

}  // namespace fast_edi
