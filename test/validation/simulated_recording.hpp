/// \file
/// A simulated recording, told to a validator in messages that may lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "simulation/davis_simulator.hpp"
#include "simulation/recording_faults.hpp"
#include "support/event_generators.hpp"
#include "validation/recording_validator.hpp"

namespace fast_edi::testing {

class SimulatedRecording {
 public:
  explicit SimulatedRecording(const SimulationSettings& settings)
      : settings_(settings), sequence_(simulateSequence(settings)) {}

  struct Told {
    ExposureInstant stamp = ExposureInstant::kMid;
    std::string fault;  ///< of the events' clock and polarity
    bool exposures = true;
    int exposure_of = 0;  ///< 1: of the next frame
    AssumedParameters parameters;
  };

  ValidationReport validate(const Told& told) const {
    RecordingFaults faults;
    if (!told.fault.empty()) {
      plantFault(told.fault, faults);
    }
    FaultyStream faulty(faults, settings_.sensor.size, settings_.timing);
    std::vector<Event> events = sequence_.events;
    faulty.apply({}, events);
    for (Event& event : events) {
      event.t_ns = faulty.eventStamp(event.t_ns);
    }
    const std::vector<std::uint8_t> wire = toWire(events);
    AssumedParameters parameters = told.parameters;
    parameters.thresholds = settings_.sensor.thresholds;
    parameters.thresholds_given = true;
    DeblurParameters pipeline;
    pipeline.thresholds = parameters.thresholds;
    RecordingValidator validator(parameters, pipeline);
    tell(told, faulty, wireView(wire), validator);
    if (validator.endSurvey()) {
      tell(told, faulty, wireView(wire), validator);
    }
    return validator.finish(nullptr);
  }

 private:
  void tell(const Told& told, const FaultyStream& faulty, const WireEvents& events,
            RecordingValidator& validator) const {
    // Arrays of 5 ms between the frames.
    std::uint32_t sequence = 0;
    std::size_t told_events = 0;
    const auto tellEventsUntil = [&](std::int64_t true_ns) {
      const std::int64_t until_ns = faulty.eventStamp(true_ns);
      while (told_events < events.count) {
        const std::int64_t first_ns = decodeWireEvent(events.record(told_events)).t_ns;
        const std::int64_t end_ns = first_ns + kArray_ns;
        if (end_ns > until_ns) {
          return;
        }
        std::size_t count = 0;
        while (told_events + count < events.count &&
               decodeWireEvent(events.record(told_events + count)).t_ns < end_ns) {
          ++count;
        }
        validator.addEvents({events.record(told_events), count},
                            faulty.eventSize(settings_.sensor.size), sequence++,
                            true_ns - (until_ns - end_ns));
        told_events += count;
      }
    };
    for (std::size_t i = 0; i < sequence_.frames.size(); ++i) {
      const SimulatedFrame& simulated = sequence_.frames[i];
      FrameMessage frame;
      frame.stamp_ns = faulty.frameStamp(simulated.exposure.at(told.stamp));
      frame.sequence = static_cast<std::uint32_t>(i);
      frame.record_ns = simulated.exposure.end_ns;
      tellEventsUntil(frame.record_ns);
      frame.size = settings_.sensor.size;
      frame.pixels.data = simulated.blurry.data;
      frame.pixels.size = frame.size;
      frame.pixels.step = simulated.blurry.step;
      validator.addFrame(frame);
      if (told.exposures) {
        validator.addExposure(static_cast<std::int32_t>(settings_.timing.exposureUs(
                                  static_cast<int>(i) + told.exposure_of)),
                              frame.record_ns + kNanosecondsPerMicrosecond);
      }
    }
    tellEventsUntil(sequence_.frames.back().exposure.end_ns + kNanosecondsPerSecond);
  }

  static constexpr std::int64_t kArray_ns = 5 * kNanosecondsPerMillisecond;

  SimulationSettings settings_;
  SimulatedSequence sequence_;
};

}  // namespace fast_edi::testing
