/// \file
/// The range of stamps of messages: 32-bit seconds, from 0.
#pragma once

#include <cstdint>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// The last of them; the first one is 0.
constexpr std::int64_t kLastStamp_ns = (std::int64_t{1} << 32) * kNanosecondsPerSecond - 1;

inline bool isStamp(std::int64_t t_ns) {
  return t_ns >= 0 && t_ns <= kLastStamp_ns;
}

}  // namespace fast_edi
