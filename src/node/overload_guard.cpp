#include "node/overload_guard.hpp"

namespace fast_edi {

OverloadGuard::Action OverloadGuard::update(std::int64_t now_ns, const Counts& counts) {
  if (!started_) {
    started_ = true;
    beginWindow(now_ns, counts);
    return Action::kNone;
  }
  if (suspended_) {
    if (now_ns - since_ns_ < kPause_ns) {
      return Action::kNone;
    }
    suspended_ = false;
    beginWindow(now_ns, counts);
    return Action::kResume;
  }
  if (now_ns - since_ns_ < kWindow_ns) {
    return Action::kNone;
  }
  const std::uint64_t events = counts.events - before_.events;
  const std::uint64_t lost = counts.events_lost - before_.events_lost;
  if (counts.frames > before_.frames) {
    last_frame_ns_ = now_ns;
  }
  const bool frames_come = last_frame_ns_ && now_ns - *last_frame_ns_ <= kLongestFrameGap_ns;
  overloaded_windows_ = frames_come && 2 * lost > events ? overloaded_windows_ + 1 : 0;
  beginWindow(now_ns, counts);
  if (overloaded_windows_ < kWindows) {
    return Action::kNone;
  }
  overloaded_windows_ = 0;
  suspended_ = true;
  return Action::kSuspend;
}

void OverloadGuard::beginWindow(std::int64_t now_ns, const Counts& counts) {
  since_ns_ = now_ns;
  before_ = counts;
}

}  // namespace fast_edi
