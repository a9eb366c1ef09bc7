#include "fast_edi/events/event_coverage.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

/// Beyond this many, all time before the end of the oldest hole counts as not covered.
constexpr std::size_t kMaxHoles = 64;

}  // namespace

void EventCoverage::reset() {
  started_ = false;
  holes_.clear();
  open_ = false;
}

void EventCoverage::start(std::int64_t first_event_ns) {
  started_ = true;
  began_ns_ = first_event_ns - kStartSlack_ns;
  from_ns_ = began_ns_;
}

void EventCoverage::discardBefore(std::int64_t t_ns) {
  from_ns_ = std::max(from_ns_, t_ns);
  const auto is_past = [&](const ExposureInterval& hole) { return hole.end_ns <= from_ns_; };
  holes_.erase(std::remove_if(holes_.begin(), holes_.end(), is_past), holes_.end());
}

void EventCoverage::openHole(std::int64_t from_ns) {
  if (!open_) {
    open_ = true;
    open_from_ns_ = from_ns;
  }
}

void EventCoverage::closeHole(std::int64_t until_ns) {
  open_ = false;
  if (holes_.size() == kMaxHoles) {
    discardBefore(holes_.front().end_ns);
  }
  holes_.push_back({open_from_ns_, std::max(until_ns, open_from_ns_ + 1)});
}

bool EventCoverage::covers(const ExposureInterval& interval) const {
  if (!started_ || interval.start_ns < from_ns_) {
    return false;
  }
  if (open_ && interval.end_ns > open_from_ns_) {
    return false;
  }
  return std::none_of(holes_.begin(), holes_.end(), [&](const ExposureInterval& hole) {
    return interval.start_ns < hole.end_ns && interval.end_ns > hole.start_ns;
  });
}

}  // namespace fast_edi
