/// \file
/// What one pass over a recording gathers for the checks.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/events/sequence_gaps.hpp"
#include "survey/clock_relation.hpp"
#include "survey/event_statistics.hpp"
#include "survey/event_timeline.hpp"
#include "survey/finding.hpp"
#include "survey/frame_log.hpp"

namespace fast_edi {

/// The settings that the recording is compared with.
struct AssumedParameters {
  ContrastThresholds thresholds{0.25, 0.25};
  bool thresholds_given = false;
  ExposureInstant stamp_reference = ExposureInstant::kMid;
  std::int64_t time_offset_ns = 0;
  std::int64_t exposure_time_ns = 0;     ///< 0 = not known
  bool exposure_from_parameter = false;  ///< exposure messages are not used
  RecordingOrigin origin = RecordingOrigin::kRosDriver;
};

class RecordingSurvey {
 public:
  /// Shorter exposures are rather values in milliseconds.
  static constexpr std::int64_t kLeastExposure_us = 100;

  /// Messages are recorded this long after their stamps at most: clocks that seem to differ by more
  /// do differ.
  static constexpr std::int64_t kLargestDelay_ns = 300 * kNanosecondsPerMillisecond;

  explicit RecordingSurvey(const AssumedParameters& parameters) : parameters_(parameters) {}

  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t record_ns);
  void addFrame(const FrameMessage& frame);
  void addExposure(std::int32_t exposure_us, std::int64_t record_ns);
  void finish();

  const AssumedParameters& parameters() const { return parameters_; }
  const EventTimeline& timeline() const { return timeline_; }
  const FrameLog& frames() const { return frames_; }
  /// Of the first size stated; null without events.
  const EventStatistics* statistics() const { return statistics_ ? &*statistics_ : nullptr; }
  /// Event arrays by the size that they state, as {width, height}.
  const std::map<std::pair<int, int>, std::uint64_t>& eventSizes() const { return event_sizes_; }
  std::uint64_t arrayGaps() const { return array_gaps_; }
  /// By the times at which messages were recorded, from finish() on; empty without frames or
  /// events.
  const std::optional<ClockRelation>& clocks() const { return clocks_; }
  /// Events minus frames, from finish() on: good to some ten milliseconds. Where frame stamps were
  /// multiplied by a simple number, frames() has them with that undone, and this is for those.
  std::int64_t roughClockOffsetNs() const { return rough_offset_ns_; }
  /// Typical value of the exposure messages, 0 = none [us].
  std::int64_t typicalExposureUs() const;
  /// False when the exposure messages cannot be exposure times in microseconds.
  bool exposuresPlausible() const;
  /// Length of a frame's exposure as fast_edi would take it, 0 = not known [ns].
  std::int64_t assumedLengthNs(const LoggedFrame& frame) const;
  /// The same in event time with the assumed parameters; empty while the length is not known.
  std::optional<ExposureInterval> assumedExposure(const LoggedFrame& frame) const;

 private:
  AssumedParameters parameters_;
  EventTimeline timeline_;
  FrameLog frames_;
  std::optional<EventStatistics> statistics_;
  std::map<std::pair<int, int>, std::uint64_t> event_sizes_;
  SequenceGaps sequence_gaps_;
  std::uint64_t array_gaps_ = 0;
  bool use_messages_ = false;  ///< exposure messages, from finish() on
  struct ArrayReading {
    ClockReading clock;
    std::size_t epoch = 0;
  };
  void relate();

  std::vector<ArrayReading> arrays_;
  std::optional<ClockRelation> clocks_;
  std::int64_t rough_offset_ns_ = 0;
};

}  // namespace fast_edi
