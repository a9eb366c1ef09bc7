/// \file
/// What a simulated sequence gives to a pipeline: events as they come over the wire, and what is
/// known of its sensor.
#pragma once

#include <cstdint>
#include <vector>

#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Events as wire records in arrays, as a driver sends them.
class WireArrays {
 public:
  struct Array {
    WireEvents events;  ///< until the next pack()
    std::uint32_t sequence = 0;
  };

  Array pack(const std::vector<Event>& events) {
    bytes_.clear();
    bytes_.reserve(events.size() * kWireEventBytes);
    for (const Event& event : events) {
      encodeWireEvent(event, bytes_);
    }
    return {{bytes_.data(), events.size()}, sequence_++};
  }

 private:
  std::vector<std::uint8_t> bytes_;
  std::uint32_t sequence_ = 0;
};

/// \p parameters with the simulated sensor's thresholds, times \p threshold_factor, and exposure;
/// latent images show mid-exposure, where truth is known.
inline DeblurParameters sensorParameters(const DeblurParameters& parameters,
                                         const SimulationSettings& settings,
                                         double threshold_factor) {
  DeblurParameters known = parameters;
  known.thresholds = {settings.sensor.thresholds.on * threshold_factor,
                      settings.sensor.thresholds.off * threshold_factor};
  known.exposure_source = ExposureSource::kParameter;
  known.exposure_time_ns = settings.timing.exposure_us * kNanosecondsPerMicrosecond;
  known.stamp_reference = ExposureInstant::kMid;
  known.reference = ExposureInstant::kMid;  // of the true frames
  known.time_offset_ns = 0;
  known.response = CameraResponse::linear();
  return known;
}

}  // namespace fast_edi
