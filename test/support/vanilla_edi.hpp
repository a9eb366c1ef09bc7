/// \file
/// Array-like ("vanilla") event-based double integral: the whole latent image is kept, and added to
/// an accumulator at every event. O(events x pixels): the baseline that lists replace.
///
/// Counter weighting. Event number i (from 0) of the window changes its pixel, then the whole image
/// is added once: N additions for N events. So the initial value of a pixel counts as many times as
/// there are events before its first one, and the value after event i counts j - i times, j being
/// the pixel's next event (N after its last one). E = sum / N / level at the reference time; 1
/// without events.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"

namespace fast_edi::testing {

class VanillaEdi {
 public:
  VanillaEdi(SensorSize size, ContrastThresholds thresholds);

  /// Starts a new frame. Vanilla EDI has to know the window beforehand.
  void begin(const ExposureInterval& window, std::int64_t reference_ns);
  /// Events outside the window or the sensor are left out.
  void add(const Event& event);
  void add(const WireEvents& events);

  /// E(reference) of every pixel from the events so far, row-major.
  std::vector<double> doubleIntegral() const;
  /// Writes the latent image of a frame. Both images have pixelCount() bytes, row-major.
  void writeImage(const std::uint8_t* blurry, std::uint8_t* latent) const;
  /// Bytes of the four images.
  std::size_t memoryBytes() const { return 4 * latent_.size() * sizeof(double); }

 private:
  double valueAt(std::size_t pixel) const;
  const std::vector<double>& referenceImage() const;

  SensorSize size_;
  ContrastThresholds thresholds_;
  ExposureInterval window_;
  std::int64_t reference_ns_ = 0;
  std::int64_t event_count_ = 0;
  bool reference_passed_ = false;
  std::vector<double> level_;        ///< log intensity relative to the window's start
  std::vector<double> latent_;       ///< exp(level_)
  std::vector<double> accumulator_;  ///< sum of latent_ over the events
  std::vector<double> reference_;    ///< latent_ at the reference time
};

}  // namespace fast_edi::testing
