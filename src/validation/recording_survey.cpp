#include "fast_edi/validation/recording_survey.hpp"

#include <algorithm>

#include "fast_edi/core/exposure_window.hpp"

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
  array_delays_ns_.push_back(record_ns - timeline_.epochs().back().last_ns);
}

void RecordingSurvey::addFrame(const FrameMessage& frame) {
  frames_.addFrame(frame, timeline_.epochs().empty() ? 0 : timeline_.epochs().size() - 1);
}

void RecordingSurvey::addExposure(std::int32_t exposure_us, std::int64_t record_ns) {
  frames_.addExposure(exposure_us, record_ns);
}

void RecordingSurvey::finish() {
  frames_.finish();
  use_messages_ = !parameters_.exposure_from_parameter && exposuresPlausible();
}

std::int64_t RecordingSurvey::roughClockOffsetNs() const {
  std::vector<std::int64_t> frame_delays_ns;
  for (const LoggedFrame& frame : frames_.frames()) {
    frame_delays_ns.push_back(frame.record_ns - frame.stamp_ns);
  }
  return frame_delays_ns.empty() || array_delays_ns_.empty()
             ? 0
             : median(std::move(frame_delays_ns)) - median(array_delays_ns_);
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
