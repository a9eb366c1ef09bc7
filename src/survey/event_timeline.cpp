#include "survey/event_timeline.hpp"

#include <algorithm>
#include <cstdlib>

namespace fast_edi {

std::uint64_t EventEpoch::count(const ExposureInterval& interval) const {
  const std::int64_t end = std::min<std::int64_t>((interval.end_ns - first_ns) / kBin_ns,
                                                  static_cast<std::int64_t>(bins.size()));
  std::uint64_t sum = 0;
  for (std::int64_t bin = std::max<std::int64_t>(0, (interval.start_ns - first_ns) / kBin_ns);
       bin < end; ++bin) {
    sum += bins[static_cast<std::size_t>(bin)];
  }
  return sum;
}

void EventTimeline::beginEpoch(std::int64_t t_ns) {
  epochs_.emplace_back();
  epochs_.back().first_ns = t_ns;
  epochs_.back().last_ns = t_ns;
}

void EventTimeline::add(std::int64_t t_ns) {
  ++events_;
  if (epochs_.empty()) {
    beginEpoch(t_ns);
  }
  const std::int64_t step_ns = t_ns - epochs_.back().last_ns;
  if (step_ns < -kMaxBackwardJump_ns || step_ns > kMaxForwardJump_ns) {
    if (backward_jumps_ + forward_jumps_ == 0) {
      first_jump_to_ns_ = t_ns;
    }
    ++(step_ns < 0 ? backward_jumps_ : forward_jumps_);
    largest_jump_ns_ = std::max(largest_jump_ns_, std::abs(step_ns));
    beginEpoch(t_ns);
  } else if (step_ns < 0) {
    ++unordered_;
    largest_step_back_ns_ = std::max(largest_step_back_ns_, -step_ns);
    return;
  }
  EventEpoch& epoch = epochs_.back();
  if (t_ns - epoch.last_ns > kLeastPause_ns) {
    epoch.pauses.push_back({epoch.last_ns, t_ns});
  }
  epoch.last_ns = t_ns;
  ++epoch.events;
  const auto bin = static_cast<std::size_t>((t_ns - epoch.first_ns) / EventEpoch::kBin_ns);
  if (bin >= epoch.bins.size()) {
    epoch.bins.resize(bin + 1);
  }
  ++epoch.bins[bin];
}

const EventEpoch* EventTimeline::longestEpoch() const {
  const auto longest = std::max_element(
      epochs_.begin(), epochs_.end(),
      [](const EventEpoch& a, const EventEpoch& b) { return a.events < b.events; });
  return longest == epochs_.end() ? nullptr : &*longest;
}

}  // namespace fast_edi
