/// \file
/// A packet of events as AEDAT4 stores it, made without Aedat4Writer, which has limits of its own.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "recording/aedat4_header.hpp"
#include "recording/flatbuffer_writer.hpp"

namespace fast_edi::testing {

/// An event as it lies in a packet.
struct StoredEvent {
  std::int64_t t_us = 0;
  std::int16_t x = 0;
  std::int16_t y = 0;
  std::uint8_t on = 0;
  std::array<std::uint8_t, 3> padding = {};
};

inline std::vector<std::uint8_t> packetOf(const std::vector<StoredEvent>& events) {
  FlatBufferWriter buffer(kAedat4Events);
  std::vector<FlatBufferWriter::Reference> places;
  buffer.setRoot(buffer.table({FlatBufferWriter::reference(0)}, places));
  buffer.vector(places[0], events.data(), events.size(), sizeof(StoredEvent),
                alignof(std::int64_t));
  return buffer.finish();
}

}  // namespace fast_edi::testing
