#include "survey/frame_log.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

/// As close_timeout_ms is by default.
constexpr std::int64_t kPairingTimeout_ns = 100 * kNanosecondsPerMillisecond;

}  // namespace

FrameLog::FrameLog() : pairing_(kPairingTimeout_ns, counters_) {}

void FrameLog::apply(const std::vector<ExposureMatch>& matches) {
  for (const ExposureMatch& match : matches) {
    frames_[match.image].length_ns = match.length_ns.value_or(0);
  }
}

void FrameLog::addFrame(const FrameMessage& frame, std::size_t epoch) {
  if (!frames_.empty()) {
    const std::int64_t step_ns = frame.stamp_ns - frames_.back().stamp_ns;
    repeated_stamps_ += step_ns == 0 ? 1 : 0;
    earlier_stamps_ += step_ns < 0 ? 1 : 0;
  }
  gaps_ += sequence_gaps_.step(frame.sequence) == SequenceStep::kGap ? 1 : 0;
  if (!frame.fault.empty()) {
    ++faults_[frame.fault];
  }
  LoggedFrame logged;
  logged.stamp_ns = frame.stamp_ns;
  logged.record_ns = frame.record_ns;
  logged.size = frame.size;
  logged.supported = frame.fault.empty();
  logged.epoch = epoch;
  frames_.push_back(logged);
  now_ns_ = std::max(now_ns_, frame.record_ns);
  std::vector<ExposureMatch> matches;
  pairing_.addImage(frames_.size() - 1, now_ns_, matches);
  apply(matches);
}

void FrameLog::addExposure(std::int32_t exposure_us, std::int64_t record_ns) {
  exposures_us_.push_back(exposure_us);
  now_ns_ = std::max(now_ns_, record_ns);
  std::vector<ExposureMatch> matches;
  pairing_.addMessage(exposure_us, now_ns_, matches);
  apply(matches);
}

void FrameLog::finish() {
  std::vector<ExposureMatch> matches;
  pairing_.finish(matches);
  apply(matches);
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    frames_[i].previous_length_ns = frames_[i - 1].length_ns;
  }
}

void FrameLog::changeStamps(const std::function<std::int64_t(std::int64_t stamp_ns)>& change) {
  for (LoggedFrame& frame : frames_) {
    frame.stamp_ns = change(frame.stamp_ns);
  }
}

std::int64_t FrameLog::periodNs() const {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    const std::int64_t step_ns = frames_[i].stamp_ns - frames_[i - 1].stamp_ns;
    if (step_ns > 0) {
      steps.push_back(step_ns);
    }
  }
  if (steps.empty()) {
    return 0;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace fast_edi
