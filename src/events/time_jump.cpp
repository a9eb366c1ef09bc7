#include "fast_edi/events/time_jump.hpp"

#include <cstdlib>

namespace fast_edi {

bool TimeJump::continues(std::int64_t previous_ns, std::int64_t t_ns) const {
  if (forward && t_ns - newest_ns <= max_forward_jump_ns) {
    return false;
  }
  return std::abs(t_ns - previous_ns) < std::abs(t_ns - newest_ns);
}

std::size_t TimeJump::runLength(const WireEvents& events) const {
  std::int64_t previous_ns = decodeWireEvent(events.record(0)).t_ns;
  std::size_t length = 1;
  while (length < events.count) {
    const std::int64_t t_ns = decodeWireEvent(events.record(length)).t_ns;
    if (!continues(previous_ns, t_ns)) {
      break;
    }
    previous_ns = t_ns;
    ++length;
  }
  return length;
}

}  // namespace fast_edi
