/// \file
/// Inline decoding of wire records for the baselines, so that no call per event slows them down.
#pragma once

#include <cstdint>
#include <cstring>

#include "fast_edi/events/event_wire.hpp"

namespace fast_edi::testing {

/// Same layout and meaning as decodeWireEvent(). \pre little-endian host
inline Event readWireEvent(const std::uint8_t* record) {
  std::uint16_t x, y;
  std::uint32_t sec, nsec;
  std::memcpy(&x, record, sizeof x);
  std::memcpy(&y, record + 2, sizeof y);
  std::memcpy(&sec, record + 4, sizeof sec);
  std::memcpy(&nsec, record + 8, sizeof nsec);
  return {x, y, static_cast<std::int64_t>(sec) * kNanosecondsPerSecond + nsec, record[12] != 0};
}

}  // namespace fast_edi::testing
