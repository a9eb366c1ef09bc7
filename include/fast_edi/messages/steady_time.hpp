/// \file
/// The host's clock that never goes back, for latencies and timeouts.
#pragma once

#include <chrono>
#include <cstdint>

namespace fast_edi {

/// Time since an unknown but fixed instant [ns].
inline std::int64_t steadyNow() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace fast_edi
