/// \file
/// From the structs that `dvs_msgs` generates to wire records, for event arrays that a publisher in
/// the same process hands over as a pointer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "fast_edi/events/event_wire.hpp"

namespace fast_edi {

/// Packs generated events (16 bytes each, padded) into wire records.
/// \tparam Events a container of structs with x, y, ts {sec, nsec}, polarity
/// \param records reused memory that the returned view points to
template <typename Events>
WireEvents packGeneratedEvents(const Events& events, std::vector<std::uint8_t>& records) {
  records.resize(events.size() * kWireEventBytes);
  std::uint8_t* out = records.data();
  for (const auto& event : events) {
    // ROS itself runs on little-endian machines alone, and its wire format is their memory layout.
    const std::uint16_t x = event.x;
    const std::uint16_t y = event.y;
    const std::uint32_t sec = event.ts.sec;
    const std::uint32_t nsec = event.ts.nsec;
    std::memcpy(out, &x, sizeof(x));
    std::memcpy(out + 2, &y, sizeof(y));
    std::memcpy(out + 4, &sec, sizeof(sec));
    std::memcpy(out + 8, &nsec, sizeof(nsec));
    out[12] = event.polarity ? 1 : 0;
    out += kWireEventBytes;
  }
  return {records.data(), events.size()};
}

}  // namespace fast_edi
