/// \file
/// Faults that recordings of real cameras have, planted into a simulated one. Filters work as those
/// of davis_ros_driver do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_mapping.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Which faults, and how strong; 0 = not planted.
struct RecordingFaults {
  // Of the events.
  std::int64_t background_activity_filter_us = 0;
  std::int64_t refractory_filter_us = 0;
  std::int64_t skip_filter = 0;  ///< events let through before one is skipped
  std::int64_t suppress_on = 0;
  std::int64_t suppress_off = 0;
  std::int64_t flatten_polarity = 0;
  std::int64_t invert_polarity = 0;
  std::int64_t event_hole_ms = 0;
  std::int64_t no_events_between = 0;
  std::int64_t event_orientation = 0;  ///< place in kEventOrientations of what undoes it
  std::int64_t coordinates_from = 0;
  std::int64_t unordered_events = 0;  ///< one in so many events comes 200 us too early
  // Of clocks and stamps.
  std::int64_t clock_offset_us = 0;     ///< events minus frames
  std::int64_t frame_stamps_times = 0;  ///< frame stamps are multiplied by it
  std::int64_t time_jump_back_ms = 0;
  std::int64_t start_near_1970_ms = 0;
  std::int64_t repeated_stamp = 0;
  // Of messages.
  std::int64_t dropped_arrays = 0;
  std::int64_t dropped_images = 0;
  std::int64_t exposure_of_next = 0;
  std::int64_t dropped_exposures = 0;  ///< one in so many
  std::int64_t exposure_percent = 0;   ///< what the exposure topic says, of the truth
  std::int64_t more_rows = 0;          ///< frames of the second half have so many rows more
  std::int64_t event_size = 0;         ///< event arrays state a size this much too large
  std::int64_t unknown_encoding = 0;
};

struct FaultDescription {
  const char* name;
  std::int64_t RecordingFaults::*value;
  std::int64_t usual;  ///< value when none is given
  const char* meaning;
};

/// All faults by name.
const std::vector<FaultDescription>& faultDescriptions();

/// \param fault NAME or NAME=VALUE
/// \throws std::invalid_argument for an unknown name or a value that is no number
void plantFault(const std::string& fault, RecordingFaults& faults);

/// Faults of the event stream and of the clocks. Keeps state: give it the events in order.
class FaultyStream {
 public:
  FaultyStream(const RecordingFaults& faults, SensorSize size, const TimingSettings& timing);

  /// Takes out and changes events.
  /// \param exposure the one exposure that the events' interval has
  void apply(const ExposureInterval& exposure, std::vector<Event>& events);

  /// What event arrays state: axes may be exchanged. \param size of the sensor
  SensorSize eventSize(SensorSize size) const;
  /// What an event of true time \p t_ns is stamped with, not before 0.
  std::int64_t eventStamp(std::int64_t t_ns) const;
  /// What a frame with the true stamp \p t_ns is stamped with.
  std::int64_t frameStamp(std::int64_t t_ns) const;
  /// The instant in the middle of the recording at which faults begin.
  std::int64_t middle() const { return middle_ns_; }

 private:
  std::size_t pixelIndex(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(x);
  }
  bool passes(const Event& event);
  EventMapping turned() const;
  bool isSupported(const Event& event);
  std::int64_t faultyClock(std::int64_t t_ns) const;

  RecordingFaults faults_;
  SensorSize size_;
  std::int64_t start_ns_;
  std::int64_t middle_ns_;
  std::int64_t events_ = 0;
  std::int64_t until_skip_ = 0;
  std::vector<std::int64_t> last_raw_ns_;     ///< of each pixel, before any filter
  std::vector<std::int64_t> last_passed_ns_;  ///< of each pixel, of the refractory filter
};

}  // namespace fast_edi
