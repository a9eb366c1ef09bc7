#include "support/schedule_checker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi::testing {
namespace {

/// Bytes per pixel of sums, gains, filters' input, calibration and video together.
constexpr std::size_t kBytesPerPixel = 160;

}  // namespace

InputFrame ScheduleChecker::expect(InputFrame frame) {
  const DeblurParameters& parameters = deblurrer_.parameters();
  if (has_latest_ && frame.stamp_ns < latest_ns_ - parameters.max_backward_jump_ns) {
    ++epoch_;
    has_latest_ = false;
  }
  latest_ns_ = has_latest_ ? std::max(latest_ns_, frame.stamp_ns) : frame.stamp_ns;
  has_latest_ = true;
  largest_pixels_ = std::max(largest_pixels_, frame.image.size.pixelCount());
  frame.owner = std::make_shared<std::shared_ptr<const void>>(std::move(frame.owner));
  const std::int64_t stamp_ns = std::clamp(frame.stamp_ns, std::int64_t{0}, kLastStamp_ns);
  frames_.push_back({frame.owner, stamp_ns, epoch_, pauses_});
  return frame;
}

void ScheduleChecker::expectPause() {
  ++pauses_;
  ++epoch_;
  has_latest_ = false;
}

void ScheduleChecker::expectEvents(std::size_t count) {
  largest_array_ = std::max(largest_array_, count);
}

std::string ScheduleChecker::fault() {
  const DeblurParameters& parameters = deblurrer_.parameters();
  exact_ = exact_ && parameters.reference == parameters.stamp_reference;
  for (const std::string& found : {outputFault(), countFault(), memoryFault()}) {
    if (!found.empty()) {
      return found;
    }
  }
  return {};
}

std::string ScheduleChecker::faultAtEnd() {
  const std::string found = fault();
  if (!found.empty()) {
    return found;
  }
  if (deblurrer_.status().waiting_frames > 0) {
    return "frames are waiting after finish()";
  }
  return suppressionFault(next_, frames_.size());
}

std::string ScheduleChecker::outputFault() {
  if (!sink_.isBalanced()) {
    return "begin() and finish() of the sink do not come in pairs";
  }
  for (; checked_outputs_ < sink_.outputs.size(); ++checked_outputs_) {
    const OutputFrame& output = sink_.outputs[checked_outputs_].frame;
    std::size_t found = next_;
    while (found < frames_.size() && frames_[found].owner != output.input.owner) {
      ++found;
    }
    if (found == frames_.size()) {
      return "an output that belongs to no frame still without one: a second output of a frame, or "
             "outputs out of order";
    }
    std::string suppressed = suppressionFault(next_, found);
    if (!suppressed.empty()) {
      return suppressed;
    }
    const Expected& frame = frames_[found];
    const bool same_epoch = has_output_ && frame.epoch == output_epoch_;
    if (same_epoch && output.stamp_ns <= last_output_ns_) {
      return "output stamp " + std::to_string(output.stamp_ns) + " after " +
             std::to_string(last_output_ns_) + " in the same epoch";
    }
    if (exact_ && output.stamp_ns != frame.stamp_ns) {
      return "output stamp " + std::to_string(output.stamp_ns) + " of the frame stamped " +
             std::to_string(frame.stamp_ns);
    }
    if (std::abs(output.stamp_ns - frame.stamp_ns) > kMaxExposure_ns) {
      return "output stamp further from the input's than an exposure is long";
    }
    if (output.deblurred &&
        (output.exposure.length() <= 0 || output.exposure.length() > kMaxExposure_ns)) {
      return "deblurred with an exposure of " + std::to_string(output.exposure.length()) + " ns";
    }
    gone_ += found - next_;
    next_ = found + 1;
    has_output_ = true;
    last_output_ns_ = output.stamp_ns;
    output_epoch_ = frame.epoch;
  }
  return {};
}

/// \param from, to frames of frames_ that have no output although a later one has
std::string ScheduleChecker::suppressionFault(std::size_t from, std::size_t to) const {
  for (std::size_t i = from; i < to; ++i) {
    const Expected& frame = frames_[i];
    if (frame.pauses < pauses_) {
      continue;  // it may have been waiting when the pause began
    }
    const std::int64_t tolerance_ns = exact_ ? 0 : kMaxExposure_ns;
    const bool not_later = has_output_ && frame.epoch == output_epoch_ &&
                           frame.stamp_ns <= last_output_ns_ + tolerance_ns;
    if (!not_later) {
      return "no output for the frame stamped " + std::to_string(frame.stamp_ns) +
             ", newer than the last output of its epoch";
    }
  }
  return {};
}

std::string ScheduleChecker::countFault() const {
  const DeblurCounters& c = deblurrer_.counters();
  const DeblurStatus status = deblurrer_.status();
  if (c.frames_in != frames_.size()) {
    return std::to_string(c.frames_in) + " frames counted, " + std::to_string(frames_.size()) +
           " came in";
  }
  if (c.frames_in != c.frames_deblurred + c.framesPassed() + c.frames_suppressed +
                         c.frames_abandoned + status.waiting_frames) {
    return "counts of frames do not add up";
  }
  if (c.frames_deblurred + c.framesPassed() != sink_.outputs.size()) {
    return "frames counted as put out are not those that the sink got";
  }
  if (c.frames_suppressed + c.frames_abandoned < gone_) {
    return "frames without output that are not counted";
  }
  if (c.windows_predicted + c.windows_not_predicted != c.frames_deblurred ||
      c.frames_still > c.frames_deblurred) {
    return "counts of closed frames do not add up";
  }
  if (c.events_late + c.events_outside + c.events_glitched + c.events_refused + c.events_repeated +
          c.events_overflowed + status.buffered_events >
      c.events_in) {
    return "more events dropped, refused and buffered than came in";
  }
  if (c.exposures_refused > c.exposures_in || c.exposures_surplus > c.exposures_in) {
    return "more exposures refused or surplus than came in";
  }
  const bool thresholds_usable =
      std::isfinite(status.thresholds.on) && status.thresholds.on > 0.0 &&
      std::isfinite(status.thresholds.off) && status.thresholds.off > 0.0;
  return thresholds_usable ? "" : "a contrast threshold in force is not finite and positive";
}

std::string ScheduleChecker::memoryFault() const {
  const DeblurStatus status = deblurrer_.status();
  const std::size_t max_events = deblurrer_.parameters().max_buffered_events;
  if (status.buffered_events > max_events) {
    return std::to_string(status.buffered_events) + " events buffered, more than " +
           std::to_string(max_events);
  }
  // One chunk is filled and one is only partly used; an array may be held apart as it came.
  constexpr std::size_t kChunk = PixelEventLists::kChunkEvents;
  constexpr std::size_t kChunkBytes = kChunk * (sizeof(PackedEvent) + sizeof(std::uint16_t)) + 64;
  const std::size_t bound = ((max_events + kChunk - 1) / kChunk + 2) * kChunkBytes +
                            2 * largest_array_ * kWireEventBytes + largest_pixels_ * kBytesPerPixel;
  if (status.buffer_bytes > bound) {
    return std::to_string(status.buffer_bytes) + " bytes in use, expected at most " +
           std::to_string(bound);
  }
  return {};
}

}  // namespace fast_edi::testing
