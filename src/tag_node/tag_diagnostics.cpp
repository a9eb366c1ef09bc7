#include "tag_node/tag_diagnostics.hpp"

#include <utility>

#include "fast_edi/base/number_text.hpp"
#include "fast_edi/base/types.hpp"
#include "node/repeated_messages.hpp"
#include "node/status_values.hpp"

namespace fast_edi {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

/// Longer than any camera's frame interval.
constexpr std::int64_t kSilence_ns = 2 * kNanosecondsPerSecond;

double seconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) / static_cast<double>(kNanosecondsPerSecond);
}

double milliseconds(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) / static_cast<double>(kNanosecondsPerMillisecond);
}

}  // namespace

TagDiagnostics::TagDiagnostics(std::string image_topic) : image_topic_(std::move(image_topic)) {}

void TagDiagnostics::update(const TagSnapshot& now) {
  before_ = std::exchange(now_, now);
  if (before_.time_ns == 0) {
    before_.time_ns = now.listening_since_ns;
  }
  complaints_.clear();
  const auto complain = [this](const char* kind, std::uint64_t count, std::uint64_t count_before,
                               const std::string& text) {
    if (count > count_before) {
      complaints_.push_back({kind, std::to_string(count - count_before) + " " + text});
    }
  };
  complain("refused", now_.frames_refused, before_.frames_refused,
           "image(s) on " + image_topic_ + " refused: " + now_.refusal);
  complain("repeated", now_.frames_repeated, before_.frames_repeated,
           "image(s) on " + image_topic_ + kCameTwice);
  complain("gap", now_.frame_gaps, before_.frame_gaps,
           "hole(s) in header.seq on " + image_topic_ + ": images were lost on the way");
  complain("internal error", now_.internal_errors, before_.internal_errors,
           "internal error(s): " + now_.internal_error);
}

void TagDiagnostics::summarise(DiagnosticStatusWrapper& status) const {
  if (!now_.configuration_error.empty()) {
    status.summary(DiagnosticStatus::ERROR,
                   "idle, configuration refused: " + now_.configuration_error);
    return;
  }
  if (!now_.listening) {
    status.summary(DiagnosticStatus::OK, "idle: nobody subscribes to an output");
    return;
  }
  status.summary(DiagnosticStatus::OK, "detecting tags");
  const std::int64_t last_ns =
      now_.last_frame_ns != 0 ? now_.last_frame_ns : now_.listening_since_ns;
  if (now_.time_ns - last_ns > kSilence_ns) {
    status.mergeSummary(DiagnosticStatus::ERROR, "no image on " + image_topic_ + " for " +
                                                     fixedText(seconds(now_.time_ns - last_ns), 1) +
                                                     " s");
  }
  for (const Complaint& complaint : complaints_) {
    status.mergeSummary(DiagnosticStatus::WARN, complaint.text);
  }
}

void TagDiagnostics::fill(const LatencyRecord& detection_time,
                          DiagnosticStatusWrapper& wrapper) const {
  summarise(wrapper);
  if (!now_.configuration_error.empty()) {
    return;
  }
  StatusValues status(wrapper);
  const double elapsed_s = seconds(now_.time_ns - before_.time_ns);
  const double rate_hz =
      elapsed_s > 0.0 ? static_cast<double>(now_.frames - before_.frames) / elapsed_s : 0.0;
  const double share = now_.frames > 0 ? 100.0 * static_cast<double>(now_.frames_with_tags) /
                                             static_cast<double>(now_.frames)
                                       : 0.0;
  status.addf("Frame rate [Hz]", "%.2f", rate_hz);
  status.add("Tags in the last frame", now_.tags_in_last_frame);
  status.add("Frames", now_.frames);
  status.add("Frames with tags", now_.frames_with_tags);
  status.addf("Frames with tags [%]", "%.1f", share);
  status.add("Tags", now_.tags);
  status.addf("Detection p50 [ms]", "%.3f", milliseconds(detection_time.percentile(0.5)));
  status.addf("Detection p99 [ms]", "%.3f", milliseconds(detection_time.percentile(0.99)));
  status.add("Poses", now_.no_pose_reason.empty() ? "yes" : "no: " + now_.no_pose_reason);
  status.add("Frame id",
             now_.frame_id.empty() ? "none: set the parameter frame_id" : now_.frame_id);
  status.add("Frames refused", now_.frames_refused);
  status.add("Frame gaps", now_.frame_gaps);
  status.add("Frames repeated", now_.frames_repeated);
  status.add("Internal errors", now_.internal_errors);
}

}  // namespace fast_edi
