/// \file
/// Takes the noise of events out of the gains before they touch the frame.
///
/// Events are noisy (threshold quantisation, shot noise, leak events, hot pixels), frames hardly.
/// So what is filtered is the map of log gains log L(f) - log B, not the image: texture that the
/// frame shows is not in this map and cannot be lost.
///
/// 1. Despeckle: each log gain is limited to the range of its eight neighbours'. An event that no
///    neighbour confirms, a hot pixel, a pixel out of range has no effect. (Lines one pixel wide
///    stay: they go on in a neighbour.)
/// 2. Smooth: EdgePreservingFilter over 5 x 5 pixels.
/// 3. Restore: GainRestoration.
#pragma once

#include <vector>

#include "fast_edi/core/edge_preserving_filter.hpp"
#include "fast_edi/core/gain_restoration.hpp"
#include "fast_edi/core/types.hpp"

namespace fast_edi {

class GainFilter {
 public:
  struct Settings {
    bool despeckle = true;
    bool smooth = true;
    float range_log = 0.35F;        ///< what counts as an edge of the log gain [natural log], > 0
    float spatial_sigma_px = 0.9F;  ///< [px], > 0
    float restore = 0.35F;          ///< strength of GainRestoration, 0 = none
  };

  /// \throws std::invalid_argument when a setting is out of range
  GainFilter(SensorSize size, const Settings& settings);

  /// Filters width x height gains in place.
  /// \pre every gain lies within [DoubleIntegral::kMinGain, kMaxGain]
  void apply(float* gain);

  std::size_t memoryBytes() const;

 private:
  void despeckle();

  SensorSize size_;
  Settings settings_;
  EdgePreservingFilter smoother_;
  GainRestoration restoration_;
  std::vector<float> log_gain_;
  std::vector<float> despeckled_;
  std::vector<float> lowest_;  ///< of the neighbours of one row
  std::vector<float> highest_;
};

}  // namespace fast_edi
