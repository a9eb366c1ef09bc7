#include "fast_edi/exposure/exposure_window.hpp"

namespace fast_edi {

ExposureInterval exposureInterval(std::int64_t stamp_ns, std::int64_t length_ns,
                                  ExposureInstant stamp_reference) {
  const ExposureInterval from_zero{0, length_ns};
  const std::int64_t start_ns = stamp_ns - from_zero.at(stamp_reference);
  return {start_ns, start_ns + length_ns};
}

void ExposureWindow::settle(std::optional<std::int64_t> length_ns) {
  source_ = length_ns ? Source::kMessage : Source::kParameter;
  message_length_ns_ = length_ns.value_or(0);
}

std::int64_t ExposureWindow::length(const DeblurParameters& parameters) const {
  switch (source_) {
    case Source::kMessage:
      return message_length_ns_;
    case Source::kParameter:
      return parameters.exposure_time_ns;
    case Source::kAwaited:
      break;
  }
  return 0;
}

ExposureInterval ExposureWindow::inFrameTime(const DeblurParameters& parameters) const {
  return exposureInterval(stamp_ns_, length(parameters), parameters.stamp_reference);
}

ExposureInterval ExposureWindow::inEventTime(const DeblurParameters& parameters) const {
  const ExposureInterval interval = inFrameTime(parameters);
  return {interval.start_ns + parameters.time_offset_ns,
          interval.end_ns + parameters.time_offset_ns};
}

/// \return nullopt when the exposure can be deblurred with the events that have come
std::optional<PassReason> ExposureWindow::whyNotCovered(const FrameTraits& frame,
                                                        const EventStream& events,
                                                        const ExposureInterval& window) const {
  if (!events.covers(window)) {
    return events.beganAfter(window.end_ns + kClocksDiffer_ns) ? PassReason::kClocksDiffer
                                                               : PassReason::kEventsMissing;
  }
  if (events.hasReached(window.start_ns) || (frame.stream_silent && !frame.clocks_differed)) {
    return std::nullopt;
  }
  return events.hasReached(window.start_ns - kClocksDiffer_ns) ? PassReason::kEventsMissing
                                                               : PassReason::kClocksDiffer;
}

FrameVerdict ExposureWindow::judge(const FrameTraits& frame, const EventStream& events,
                                   const DeblurParameters& parameters, bool out_of_time) const {
  const auto pass = [](PassReason reason) {
    return FrameVerdict{FrameState::kPassThrough, reason};
  };
  const auto waiting = [](FrameState state) {
    return FrameVerdict{state, PassReason::kPassthroughParameter};
  };

  if (parameters.passthrough) {
    return pass(PassReason::kPassthroughParameter);
  }
  // Passed-through frames wait for their message, too: the output stamp depends on it.
  if (awaitsMessage()) {
    return waiting(FrameState::kWaitingForExposure);
  }
  if (!frame.supported) {
    return pass(PassReason::kUnsupportedEncoding);
  }
  if (length(parameters) == 0) {
    return pass(PassReason::kExposureUnknown);
  }

  const ExposureInterval window = inEventTime(parameters);
  const bool covered = events.covers(window);
  if (!out_of_time && !events.stopped()) {
    if (!events.hasReached(window.end_ns)) {
      return waiting(FrameState::kWaitingForEvents);
    }
    if (frame.after_time_jump && !covered &&
        events.isPast(window.end_ns + parameters.max_backward_jump_ns)) {
      return waiting(FrameState::kWaitingForEventJump);
    }
  }
  if (!events.seen()) {
    return pass(PassReason::kNoEventStream);
  }
  if (frame.size != events.lists()->size()) {
    return pass(PassReason::kSizeMismatch);
  }
  if (const std::optional<PassReason> reason = whyNotCovered(frame, events, window)) {
    return pass(*reason);
  }
  return {FrameState::kReady, PassReason::kPassthroughParameter};
}

}  // namespace fast_edi
