#include "node/node_diagnostics.hpp"

#include <utility>

#include "fast_edi/base/number_text.hpp"
#include "fast_edi/base/sensor_size.hpp"
#include "node/overload_guard.hpp"
#include "node/repeated_messages.hpp"
#include "node/status_values.hpp"

namespace fast_edi {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

/// Longer than any camera's frame interval and any driver's batch of events.
constexpr std::int64_t kSilence_ns = 2 * kNanosecondsPerSecond;
constexpr double kBytesPerMegabyte = 1e6;
constexpr double kEventsPerMegaevent = 1e6;

double seconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) / static_cast<double>(kNanosecondsPerSecond);
}

double milliseconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) / static_cast<double>(kNanosecondsPerMillisecond);
}

std::string secondsText(std::int64_t duration_ns) {
  return fixedText(seconds(duration_ns), 1) + " s";
}

std::string sizeText(const SensorSize& size) {
  return fast_edi::sizeText(size.width, size.height);
}

/// What a user can do about frames that are passed through.
std::string adviceFor(PassReason reason, const NodeSnapshot& now, const InputTopics& topics) {
  switch (reason) {
    case PassReason::kPassthroughParameter:
      return "as the parameter passthrough says";
    case PassReason::kUnsupportedEncoding:
      return now.unsupported_reason;
    case PassReason::kSizeMismatch:
      return "expected frames of the event arrays' size, " + sizeText(now.status.sensor_size);
    case PassReason::kExposureUnknown:
      return "expected messages on " + topics.exposure + " or the parameter exposure_time_us";
    case PassReason::kNoEventStream:
      return "expected event arrays on " + topics.events;
    case PassReason::kEventsMissing:
      return "expected all events of the exposure on " + topics.events;
    case PassReason::kClocksDiffer:
      return "expected events on " + topics.events + " within 1 s of the exposure; " +
             toString(now.status.differing_clocks) + ": see time_offset_us";
    case PassReason::kTooManyWaiting:
      return "expected their events on " + topics.events + " sooner, or a shorter close_timeout_ms";
  }
  return "";
}

}  // namespace

NodeDiagnostics::NodeDiagnostics(InputTopics topics) : topics_(std::move(topics)) {}

void NodeDiagnostics::update(const NodeSnapshot& now) {
  before_ = std::exchange(now_, now);
  if (before_.time_ns == 0) {
    before_.time_ns = now.listening_since_ns;
  }
  collectComplaints(now_);
}

void NodeDiagnostics::collectComplaints(const NodeSnapshot& now) {
  complaints_.clear();
  const auto complain = [this](const char* kind, std::uint64_t count, std::uint64_t count_before,
                               const std::string& text) {
    if (count > count_before) {
      complaints_.push_back({kind, std::to_string(count - count_before) + " " + text});
    }
  };
  const DeblurCounters& c = now.counters;
  const DeblurCounters& b = before_.counters;
  const std::string on_events = " on " + topics_.events;
  const std::string on_image = " on " + topics_.image;
  const std::string on_exposure = " on " + topics_.exposure;

  complain("malformed", now.frames_malformed, before_.frames_malformed,
           "image(s)" + on_image + " refused: " + now.malformed_reason);
  complain("image gap", now.frames_missing, before_.frames_missing,
           "frame(s)" + on_image + " lost on the way, by the holes in header.seq");
  complain("repeated", now.messages_repeated, before_.messages_repeated,
           "message(s)" + on_events + "," + on_image + " or" + on_exposure + kCameTwice);
  complain("camera info", now.camera_infos_refused, before_.camera_infos_refused,
           "camera_info(s) beside " + topics_.image +
               " refused, the one before kept: " + now.camera_info_refusal);
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    const auto reason = static_cast<PassReason>(i);
    if (reason == PassReason::kPassthroughParameter) {
      continue;  // what the user asked for
    }
    complain(toString(reason), c.frames_passed[i], b.frames_passed[i],
             "frame(s)" + on_image + " passed through unchanged: " + toString(reason) + "; " +
                 adviceFor(reason, now, topics_));
  }
  complain("suppressed", c.frames_suppressed, b.frames_suppressed,
           "frame(s)" + on_image + " gave no output: expected stamps that increase");
  complain("overflow", c.events_overflowed, b.events_overflowed,
           "event(s)" + on_events + " dropped: more than max_buffered_events at once");
  complain("suspended", now.event_suspensions, before_.event_suspensions,
           "time(s) that no events" + on_events + " were received for " +
               secondsText(OverloadGuard::kPause_ns) +
               ", suspended by overload: frames are passed through meanwhile");
  complain("late", c.events_late, b.events_late,
           "event(s)" + on_events + " dropped: older than the newest, expected increasing times");
  complain("outside", c.events_outside, b.events_outside,
           "event(s)" + on_events + " dropped: outside the sensor, expected x, y within " +
               sizeText(now.status.sensor_size));
  complain("arrays refused", c.event_arrays_refused, b.event_arrays_refused,
           "event array(s)" + on_events + " with " +
               std::to_string(c.events_refused - b.events_refused) +
               " event(s) refused: expected width and height of 1 to " +
               std::to_string(kMaxSide_px));
  complain("glitch", c.events_glitched, b.events_glitched,
           "event(s)" + on_events + " dropped: a time jump that the next array did not confirm");
  complain("arrays repeated", c.event_arrays_repeated, b.event_arrays_repeated,
           "event array(s)" + on_events +
               " that had come before dropped: is the topic published twice, or a recording played "
               "twice?");
  complain("array gap", c.event_array_gaps, b.event_array_gaps,
           "hole(s) in header.seq" + on_events + ": arrays were lost on the way");
  complain("event restart", c.event_restarts, b.event_restarts,
           "restart(s) of the publisher" + on_events + ": no events in between");
  complain("event jump", c.event_time_jumps, b.event_time_jumps,
           "time jump(s) of the events" + on_events + ": restarted");
  complain("frame jump", c.frame_time_jumps, b.frame_time_jumps,
           "time jump(s) of the frames" + on_image + ": restarted");
  complain(
      "size change", c.size_changes, b.size_changes,
      "change(s) of the sensor's size" + on_events + ", now " + sizeText(now.status.sensor_size));
  complain("exposure refused", c.exposures_refused, b.exposures_refused,
           "exposure(s)" + on_exposure + " refused: expected 1 us to 1 s");
  complain("exposure surplus", c.exposures_surplus, b.exposures_surplus,
           "exposure(s)" + on_exposure + " without a frame: expected one after each frame");
  complain("exposure missing", c.exposures_missing, b.exposures_missing,
           "frame(s)" + on_image + " without their message" + on_exposure);
  complain("out of range", c.pixels_out_of_range, b.pixels_out_of_range,
           "pixel(s) left as they were: more events than a double can integrate");
  complain(
      "bias updates", now.bias_updates_refused, before_.bias_updates_refused,
      "update(s) on " + topics_.bias_updates + " refused, thresholds kept: " + now.bias_refusal);
  complain("values", now.values_refused, before_.values_refused,
           "value(s) of parameters refused, old ones kept: " + now.value_refusal);
  complain("internal error", now.internal_errors, before_.internal_errors,
           "internal error(s): " + now.internal_error);
}

void NodeDiagnostics::summarise(DiagnosticStatusWrapper& status) const {
  if (!now_.configuration_error.empty()) {
    status.summary(DiagnosticStatus::ERROR,
                   "idle, configuration refused: " + now_.configuration_error);
    return;
  }
  if (!now_.listening) {
    status.summary(DiagnosticStatus::OK, "idle: nobody subscribes to an image output");
    return;
  }
  status.summary(DiagnosticStatus::OK, "deblurring");
  const auto silence = [this](std::int64_t last_ns) {
    return now_.time_ns - (last_ns != 0 ? last_ns : now_.listening_since_ns);
  };
  if (silence(now_.last_frame_ns) > kSilence_ns) {
    status.mergeSummary(DiagnosticStatus::ERROR, "no frame on " + topics_.image + " for " +
                                                     secondsText(silence(now_.last_frame_ns)));
  }
  if (silence(now_.last_events_ns) > kSilence_ns) {
    status.mergeSummary(DiagnosticStatus::WARN, "no event array on " + topics_.events + " for " +
                                                    secondsText(silence(now_.last_events_ns)));
  }
  if (now_.master_missing) {
    status.mergeSummary(DiagnosticStatus::ERROR,
                        "the ROS master cannot be reached: inputs stay as they are");
  }
  for (const Complaint& complaint : complaints_) {
    status.mergeSummary(DiagnosticStatus::WARN, complaint.text);
  }
}

void NodeDiagnostics::fill(const LatencyRecord& close_latency, const LatencyRecord& output_latency,
                           DiagnosticStatusWrapper& wrapper) const {
  summarise(wrapper);
  if (!now_.configuration_error.empty()) {
    return;
  }
  StatusValues status(wrapper);
  const double elapsed_s = seconds(now_.time_ns - before_.time_ns);
  const auto rate = [elapsed_s](std::uint64_t now, std::uint64_t before) {
    return elapsed_s > 0.0 ? static_cast<double>(now - before) / elapsed_s : 0.0;
  };
  const auto median = [](const LatencyRecord& record) {
    return milliseconds(record.percentile(0.5));
  };
  const auto tail = [](const LatencyRecord& record) {
    return milliseconds(record.percentile(0.99));
  };
  const DeblurCounters& c = now_.counters;
  status.addf("Frame rate in [Hz]", "%.2f", rate(c.frames_in, before_.counters.frames_in));
  status.addf("Frame rate out [Hz]", "%.2f", rate(now_.frames_out, before_.frames_out));
  status.addf("Event rate [Mev/s]", "%.3f",
              rate(c.events_in, before_.counters.events_in) / kEventsPerMegaevent);
  status.addf("Event array rate [Hz]", "%.1f", rate(c.event_arrays, before_.counters.event_arrays));
  status.add("Backlog: waiting frames", now_.status.waiting_frames);
  status.add("Backlog: buffered events", now_.status.buffered_events);
  status.addf("Buffer memory [MB]", "%.1f",
              static_cast<double>(now_.status.buffer_bytes) / kBytesPerMegabyte);
  status.addf("Close latency p50 [ms]", "%.3f", median(close_latency));
  status.addf("Close latency p99 [ms]", "%.3f", tail(close_latency));
  status.addf("Image to output p50 [ms]", "%.3f", median(output_latency));
  status.addf("Image to output p99 [ms]", "%.3f", tail(output_latency));
  status.addf("Contrast threshold ON", "%.6f", now_.thresholds.on);
  status.addf("Contrast threshold OFF", "%.6f", now_.thresholds.off);
  status.add("Contrast from", now_.contrast_origin);
  status.addf("Contrast threshold ON, learned", "%.6f", now_.status.thresholds.on);
  status.addf("Contrast threshold OFF, learned", "%.6f", now_.status.thresholds.off);
  status.addf("Event delay, learned [ms]", "%.3f", milliseconds(now_.status.event_delay_ns));
  status.add("Pairs of frames learned from", c.calibration_fits);
  status.add("Pairs of frames without events between", c.calibration_holes);
  status.add("Pairs of frames that contradict their events", c.calibration_contradictions);
  status.add("Sensor size [px]", sizeText(now_.status.sensor_size));
  status.addf("Exposure [ms]", "%.3f", milliseconds(now_.status.last_exposure_ns));
  status.add("Frames in", c.frames_in);
  status.add("Frames out", now_.frames_out);
  status.add("Frames deblurred", c.frames_deblurred);
  status.add("Frames without an event", c.frames_still);
  status.add("Latent images", c.latent_images);
  status.add("Frames closed by timeout", c.frames_timed_out);
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    status.add(std::string("Frames passed through: ") + toString(static_cast<PassReason>(i)),
               c.frames_passed[i]);
  }
  status.add("Frames without output", c.frames_suppressed);
  status.add("Frames abandoned", c.frames_abandoned);
  status.add("Frames refused", now_.frames_malformed);
  status.add("Frames missing", now_.frames_missing);
  status.add("Messages repeated", now_.messages_repeated);
  status.add("Camera infos refused", now_.camera_infos_refused);
  status.add("Frame time jumps", c.frame_time_jumps);
  status.add("Events in", c.events_in);
  status.add("Events late", c.events_late);
  status.add("Events outside the sensor", c.events_outside);
  status.add("Events glitched", c.events_glitched);
  status.add("Events overflowed", c.events_overflowed);
  status.add("Events refused", c.events_refused);
  status.add("Event suspensions", now_.event_suspensions);
  status.add("Events repeated", c.events_repeated);
  status.add("Event arrays repeated", c.event_arrays_repeated);
  status.add("Event array gaps", c.event_array_gaps);
  status.add("Event arrays missing", c.event_arrays_missing);
  status.add("Event publisher restarts", c.event_restarts);
  status.add("Event time jumps", c.event_time_jumps);
  status.add("Sensor size changes", c.size_changes);
  status.add("Exposures in", c.exposures_in);
  status.add("Exposures refused", c.exposures_refused);
  status.add("Exposures without a frame", c.exposures_surplus);
  status.add("Frames without their exposure", c.exposures_missing);
  status.add("Windows predicted", c.windows_predicted);
  status.add("Windows not predicted", c.windows_not_predicted);
  status.add("Pixels out of range", c.pixels_out_of_range);
  status.add("Parameter changes", now_.reconfigurations);
  status.add("Parameter values refused", now_.values_refused);
  status.add("Internal errors", now_.internal_errors);
}

}  // namespace fast_edi
