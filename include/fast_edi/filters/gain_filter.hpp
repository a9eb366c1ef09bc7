/// \file
/// Takes the noise of events out of the gains before they touch the frame.
///
/// Events are noisy (threshold quantisation, shot noise, leak events, hot pixels), frames hardly.
/// So what is filtered is the map of log gains g = log L(f) - log B, not the image: texture that
/// the frame shows is not in this map and cannot be lost. With n the events of a pixel in the
/// exposure, n' their mean over 3 x 3 pixels and c the mean contrast threshold:
///
/// 1. HotPixelFilter.
/// 2. NonLocalMeans over 5 x 5 pixels. The noise that it takes out is that of the quantisation by
///    the thresholds and grows with the number of events:
///    s^2 = (noise c)^2 (1 + min(n', 30) / 15).
/// 3. What few events leave out: a level between two thresholds has moved further than its events
///    say, g' = g (1 + restore / (1 + (n' / 5)^2)).
#pragma once

#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/filters/exposure_events.hpp"
#include "fast_edi/filters/hot_pixel_filter.hpp"
#include "fast_edi/filters/non_local_means.hpp"

namespace fast_edi {

class GainFilter {
 public:
  struct Settings {
    bool despeckle = true;          ///< step 1
    bool smooth = true;             ///< step 2
    float noise = 0.18F;            ///< of a log gain, in contrast thresholds, > 0
    float spatial_sigma_px = 1.5F;  ///< [px], > 0
    float restore = 0.35F;          ///< step 3, see limits::kFilterGainRestore; 0 = none
  };

  /// \throws std::invalid_argument when a setting is out of range
  GainFilter(SensorSize size, const Settings& settings);

  /// Filters width x height gains in place.
  /// \param level_dn levels of the blurry frame [8-bit DN]
  /// \pre every gain lies within [kMinGain, kMaxGain]
  void apply(const float* level_dn, const ExposureEvents& events, float* gain);

  /// n' of each pixel, as the last apply() found it.
  const float* meanCounts() const { return mean_count_.data(); }

  std::size_t memoryBytes() const;

 private:
  void averageCounts();

  SensorSize size_;
  Settings settings_;
  HotPixelFilter hot_pixels_;
  NonLocalMeans smoother_;
  std::vector<float> log_gain_;
  std::vector<float> count_;
  std::vector<float> mean_count_;
  std::vector<float> variance_;
};

}  // namespace fast_edi
