#include "fast_edi/events/event_intervals.hpp"

#include <algorithm>

#include "fast_edi/base/level_model.hpp"

namespace fast_edi {
namespace {

/// A pixel's last event is kept as this old when it is older [ticks]: some minutes, well below the
/// 2^32 ticks after which its time would look recent.
constexpr std::uint32_t kOld = 1u << 30;

std::int64_t tickOf(std::int64_t t_ns) {
  static_assert(kIntervalTick_ns == 1 << 8);
  return t_ns >> 8;
}

}  // namespace

void EventIntervals::reset(std::size_t pixels) {
  last_ticks_.resize(pixels);
  has_newest_ = false;
}

/// Keeps the age of all pixels' last events within what 32 bits can tell.
void EventIntervals::forgetOld(std::int64_t tick) {
  const auto now = static_cast<std::uint32_t>(tick);
  if (!has_newest_ || tick - newest_tick_ >= kOld) {
    std::fill(last_ticks_.begin(), last_ticks_.end(), now - kOld);
    checked_tick_ = tick;
  } else if (tick - checked_tick_ >= kOld) {
    for (std::uint32_t& last : last_ticks_) {
      last = now - last > kOld ? now - kOld : last;
    }
    checked_tick_ = tick;
  }
  has_newest_ = true;
}

void EventIntervals::measure(const PackedEvent* events, std::size_t count, std::int64_t base_ns,
                             std::uint16_t* ticks) {
  if (count == 0) {
    return;
  }
  forgetOld(tickOf(base_ns + static_cast<std::int64_t>(events[0].dt_ns)));
  std::uint32_t* const last_ticks = last_ticks_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const auto tick =
        static_cast<std::uint32_t>(tickOf(base_ns + static_cast<std::int64_t>(events[i].dt_ns)));
    std::uint32_t& last = last_ticks[events[i].code >> 1];
    const std::uint32_t since = tick - last;
    last = tick;
    ticks[i] = static_cast<std::uint16_t>(
        std::min<std::uint32_t>(since - (since != 0 ? 1u : 0u), kMostIntervalTicks));
  }
  newest_tick_ = tickOf(base_ns + static_cast<std::int64_t>(events[count - 1].dt_ns));
}

}  // namespace fast_edi
