/// \file
#pragma once

#include <cstdint>
#include <optional>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {

/// Whether a stamp can hold a time of AEDAT4 [us].
inline bool isAedat4Stamp(std::int64_t t_us) {
  constexpr std::int64_t kLast_us = kLastStamp_ns / kNanosecondsPerMicrosecond;
  return t_us >= 0 && t_us <= kLast_us;
}

/// A time of AEDAT4 [us] as a stamp [ns]; nothing for a time that no stamp can hold.
inline std::optional<std::int64_t> aedat4Stamp(std::int64_t t_us) {
  return isAedat4Stamp(t_us) ? std::optional(t_us * kNanosecondsPerMicrosecond) : std::nullopt;
}

}  // namespace fast_edi
