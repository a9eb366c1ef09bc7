#include "pipeline/frame_queue.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {

FrameQueue::FrameQueue(const DeblurParameters& parameters, const EventStream& events,
                       DeblurCounters& counters)
    : parameters_(parameters),
      events_(events),
      counters_(counters),
      pairing_(parameters.close_timeout_ns, counters) {}

// --- In ------------------------------------------------------------------------------------------

void FrameQueue::advance(std::int64_t now_ns) {
  now_ns_ = std::max(now_ns_, now_ns);
  if (exposuresByTopic()) {
    pairing_.advance(now_ns_, matches_);
    assignExposures();
  }
}

void FrameQueue::addFrame(InputFrame frame) {
  ++counters_.frames_in;
  if (epoch_.jumpsBack(frame.stamp_ns, parameters_.max_backward_jump_ns)) {
    ++counters_.frame_time_jumps;
    beginEpoch(true);
  }
  epoch_.observe(frame.stamp_ns);
  if (frame.supported) {
    frame_size_ = frame.image.size;
  }
  const std::uint64_t number = next_number_++;
  const ExposureWindow window(frame.stamp_ns, exposuresByTopic());
  waiting_.push_back(
      {std::move(frame), number, epoch_.number(), epoch_.afterTimeJump(), now_ns_, window});
  if (exposuresByTopic()) {
    pairing_.addImage(number, now_ns_, matches_);
    assignExposures();
  }
}

void FrameQueue::addExposure(std::int32_t exposure_us) {
  if (!exposuresByTopic()) {
    pairing_.note(exposure_us);
    return;
  }
  pairing_.addMessage(exposure_us, now_ns_, matches_);
  assignExposures();
}

void FrameQueue::endExposures() {
  pairing_.finish(matches_);
  assignExposures();
}

void FrameQueue::restart() {
  counters_.frames_abandoned += waiting_.size();
  waiting_.clear();
  pairing_.restart();
  beginEpoch(false);
}

void FrameQueue::parametersChanged(bool exposure_source_changed) {
  pairing_.setTimeout(parameters_.close_timeout_ns);
  if (exposure_source_changed) {
    pairing_.restart();
    for (WaitingFrame& frame : waiting_) {
      settle(frame);
    }
  }
}

void FrameQueue::beginEpoch(bool after_time_jump) {
  epoch_.begin(after_time_jump);
  clocks_differ_ = false;
  predictor_.reset();
}

/// Hands lengths over to the frames that waited for them. Frames that left early are not there any
/// more; their messages still had to be counted off.
void FrameQueue::assignExposures() {
  for (const ExposureMatch& match : matches_) {
    if (waiting_.empty() || match.image < waiting_.front().number) {
      continue;
    }
    WaitingFrame& frame = waiting_[static_cast<std::size_t>(match.image - waiting_.front().number)];
    if (match.length_ns) {
      frame.window.settle(match.length_ns);
    } else {
      settle(frame);
    }
  }
  matches_.clear();
}

/// Without its own message a frame takes the last value received, else the parameter.
void FrameQueue::settle(WaitingFrame& frame) {
  if (frame.window.awaitsMessage()) {
    frame.window.settle(exposuresByTopic() ? pairing_.last() : std::nullopt);
  }
}

// --- Out -----------------------------------------------------------------------------------------

std::optional<ClosedFrame> FrameQueue::takeReady() {
  while (!waiting_.empty()) {
    WaitingFrame& front = waiting_.front();
    FrameVerdict verdict = judge(front, false);
    if (!verdict.isFinal()) {
      if (now_ns_ - front.arrival_ns < parameters_.close_timeout_ns) {
        return std::nullopt;
      }
      ++counters_.frames_timed_out;
      verdict = judgeWithWhatHasCome(front);
    }
    if (std::optional<ClosedFrame> closed = close(verdict)) {
      return closed;
    }
  }
  return std::nullopt;
}

std::optional<ClosedFrame> FrameQueue::takeSurplus() {
  while (waiting_.size() > kMaxFrames) {
    settle(waiting_.front());
    FrameVerdict verdict = judge(waiting_.front(), false);
    if (!verdict.isFinal()) {
      verdict = {FrameState::kPassThrough, PassReason::kTooManyWaiting};
    }
    if (std::optional<ClosedFrame> closed = close(verdict)) {
      return closed;
    }
  }
  return std::nullopt;
}

std::optional<ClosedFrame> FrameQueue::takeNext() {
  while (!waiting_.empty()) {
    if (std::optional<ClosedFrame> closed = close(judgeWithWhatHasCome(waiting_.front()))) {
      return closed;
    }
  }
  return std::nullopt;
}

std::optional<ClosedFrame> FrameQueue::takeBefore(std::int64_t newest_event_ns,
                                                  std::int64_t next_event_ns) {
  while (!waiting_.empty()) {
    // A frame may be there before the first event of its epoch: it belongs where it is nearer.
    const std::int64_t end_ns = waiting_.front().window.inEventTime(parameters_).end_ns;
    if (std::abs(end_ns - next_event_ns) < std::abs(end_ns - newest_event_ns)) {
      return std::nullopt;
    }
    if (std::optional<ClosedFrame> closed = close(judgeWithWhatHasCome(waiting_.front()))) {
      return closed;
    }
  }
  return std::nullopt;
}

FrameVerdict FrameQueue::judge(const WaitingFrame& frame, bool out_of_time) const {
  const std::int64_t until_ns = std::min(now_ns_, frame.arrival_ns + parameters_.close_timeout_ns);
  FrameTraits traits;
  traits.supported = frame.input.supported;
  traits.size = frame.input.image.size;
  traits.after_time_jump = frame.after_time_jump;
  traits.stream_silent =
      !last_events_ns_ || until_ns - *last_events_ns_ >= parameters_.close_timeout_ns;
  traits.clocks_differed = clocks_differ_;
  return frame.window.judge(traits, events_, parameters_, out_of_time);
}

FrameVerdict FrameQueue::judgeWithWhatHasCome(WaitingFrame& frame) {
  settle(frame);
  return judge(frame, true);
}

/// Takes the first frame out. \return nothing when it gives no output
/// \pre verdict.isFinal()
std::optional<ClosedFrame> FrameQueue::close(const FrameVerdict& verdict) {
  WaitingFrame frame = std::move(waiting_.front());
  waiting_.pop_front();

  ClosedFrame closed;
  closed.epoch = frame.epoch;
  closed.verdict = verdict;
  OutputFrame& output = closed.output;
  output.input = std::move(frame.input);
  output.stamp_ns = frame.window.stamp();
  output.exposure = {frame.window.stamp(), frame.window.stamp()};
  const bool exposure_known = !parameters_.passthrough && frame.window.length(parameters_) > 0;
  if (exposure_known) {
    output.exposure = frame.window.inFrameTime(parameters_);
    output.stamp_ns = output.exposure.at(parameters_.reference);
  }
  // A frame stamped near the beginning of time may begin before it.
  output.stamp_ns = std::clamp(output.stamp_ns, std::int64_t{0}, kLastStamp_ns);
  if (!output_order_.isLater(frame.epoch, output.stamp_ns)) {
    ++counters_.frames_suppressed;
    return std::nullopt;
  }
  output_order_.observe(frame.epoch, output.stamp_ns);

  closed.window = frame.window.inEventTime(parameters_);
  compareClocks(verdict, closed.window);
  if (exposure_known && frame.epoch == epoch_.number()) {
    predictor_.observe(output.exposure);
  }
  return closed;
}

/// Remembers that frames lie ahead of the events until the events have reached one.
void FrameQueue::compareClocks(const FrameVerdict& verdict, const ExposureInterval& window) {
  if (verdict.state == FrameState::kReady) {
    clocks_differ_ = false;
  } else if (verdict.reason == PassReason::kClocksDiffer) {
    clocks_differ_ = !events_.isPast(window.start_ns);
    differing_clocks_ = {window.at(parameters_.stamp_reference), events_.lists()->newest()};
  }
}

// --- State ---------------------------------------------------------------------------------------

std::optional<ExposureInterval> FrameQueue::nextExposure() const {
  if (waiting_.empty()) {
    return predictor_.predict();
  }
  const ExposureWindow& front = waiting_.front().window;
  const std::int64_t known_ns = front.length(parameters_);
  return exposureInterval(front.stamp(), known_ns > 0 ? known_ns : predictor_.lastLength(),
                          parameters_.stamp_reference);
}

std::int64_t FrameQueue::lastExposure() const {
  return exposuresByTopic() && pairing_.last() ? *pairing_.last() : parameters_.exposure_time_ns;
}

}  // namespace fast_edi
