#include "survey/recording_survey.hpp"

#include <algorithm>

#include "fast_edi/exposure/exposure_window.hpp"

namespace fast_edi {
namespace {

std::int64_t median(std::vector<std::int64_t> values) {
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void RecordingSurvey::addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                                std::int64_t record_ns) {
  ++event_sizes_[{size.width, size.height}];
  array_gaps_ += sequence_gaps_.step(sequence) == SequenceStep::kGap ? 1 : 0;
  if (size.pixelCount() == 0 || events.empty()) {
    return;
  }
  if (!statistics_) {
    statistics_.emplace(size);
  }
  std::size_t epochs = timeline_.epochs().size();
  for (std::size_t i = 0; i < events.count; ++i) {
    const Event event = decodeWireEvent(events.record(i));
    timeline_.add(event.t_ns);
    if (timeline_.epochs().size() != epochs) {
      epochs = timeline_.epochs().size();
      statistics_->restart(event.t_ns);
    }
    statistics_->add(event);
  }
  arrays_.push_back({{timeline_.epochs().back().last_ns, record_ns}, epochs - 1});
}

void RecordingSurvey::addFrame(const FrameMessage& frame) {
  frames_.addFrame(frame, timeline_.epochs().empty() ? 0 : timeline_.epochs().size() - 1);
}

void RecordingSurvey::addExposure(std::int32_t exposure_us, std::int64_t record_ns) {
  frames_.addExposure(exposure_us, record_ns);
}

void RecordingSurvey::finish() {
  frames_.finish();
  relate();
  use_messages_ = !parameters_.exposure_from_parameter && exposuresPlausible();
}

/// Within the longest epoch of the events: others say nothing of it.
void RecordingSurvey::relate() {
  const EventEpoch* longest = timeline_.longestEpoch();
  if (longest == nullptr) {
    return;
  }
  const auto epoch = static_cast<std::size_t>(longest - timeline_.epochs().data());
  const auto frame_readings = [&] {
    std::vector<ClockReading> readings;
    for (const LoggedFrame& frame : frames_.frames()) {
      if (frame.epoch == epoch) {
        readings.push_back({frame.stamp_ns, frame.record_ns});
      }
    }
    return readings;
  };
  std::vector<ClockReading> array_readings;
  for (const ArrayReading& array : arrays_) {
    if (array.epoch == epoch) {
      array_readings.push_back(array.clock);
    }
  }
  clocks_ = relateClocks(frame_readings(), array_readings);
  if (!clocks_) {
    return;
  }
  rough_offset_ns_ = clocks_->offset_ns;
  if (clocks_->factor != 1) {
    frames_.changeStamps([this](std::int64_t stamp_ns) { return clocks_->undone(stamp_ns); });
    rough_offset_ns_ = relateClocks(frame_readings(), array_readings)->offset_ns;
  }
}

std::int64_t RecordingSurvey::typicalExposureUs() const {
  return median({frames_.exposuresUs().begin(), frames_.exposuresUs().end()});
}

bool RecordingSurvey::exposuresPlausible() const {
  const std::int64_t typical_us = typicalExposureUs();
  return frames_.exposuresUs().empty() ||
         (typical_us >= kLeastExposure_us &&
          typical_us * kNanosecondsPerMicrosecond <= frames_.periodNs());
}

std::int64_t RecordingSurvey::assumedLengthNs(const LoggedFrame& frame) const {
  if (use_messages_ && frame.length_ns > 0) {
    return frame.length_ns;
  }
  return parameters_.exposure_time_ns;
}

std::optional<ExposureInterval> RecordingSurvey::assumedExposure(const LoggedFrame& frame) const {
  const std::int64_t length_ns = assumedLengthNs(frame);
  if (length_ns <= 0) {
    return std::nullopt;
  }
  return exposureInterval(frame.stamp_ns + parameters_.time_offset_ns, length_ns,
                          parameters_.stamp_reference);
}

}  // namespace fast_edi
