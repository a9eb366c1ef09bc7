/// \file
/// Distinguishes a jump of the event clock from stray events, as far as one array allows.
///
/// An event that is too far from the newest one begins a *run*: it and the events after it that lie
/// closer to their predecessor than to the newest event (and, for a jump ahead, beyond the limit
/// themselves). A run that ends within its array was stray events. A run that reaches the array's
/// end may be a jump.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"

namespace fast_edi {

struct TimeJump {
  std::int64_t newest_ns = 0;  ///< newest event before the run
  bool forward = false;        ///< ahead of it, else back
  std::int64_t max_forward_jump_ns = 0;

  /// \param previous_ns time of the run's last event so far
  bool continues(std::int64_t previous_ns, std::int64_t t_ns) const;
  /// How many of \p events, the first of which begins the run, belong to it.
  std::size_t runLength(const WireEvents& events) const;
};

}  // namespace fast_edi
