/// \file
/// The 13-byte record in which `dvs_msgs/Event` travels, read in place.
///
/// Layout, little endian, no padding:
///
///     byte   0  2  4         8           12
///            x  y  ts.sec    ts.nsec     polarity
///            u16   u32       u32         u8 (0 = OFF, anything else = ON)
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

constexpr std::size_t kWireEventBytes = 13;

/// A view of consecutive wire records. Owns nothing; valid as long as the bytes are.
struct WireEvents {
  const std::uint8_t* data = nullptr;
  std::size_t count = 0;

  const std::uint8_t* record(std::size_t index) const { return data + index * kWireEventBytes; }
  WireEvents from(std::size_t index) const { return {record(index), count - index}; }
  bool empty() const { return count == 0; }
};

/// Reads one record. \p record must point to kWireEventBytes readable bytes.
Event decodeWireEvent(const std::uint8_t* record);

/// Overwrites pixel and polarity of a record; its time stays as it is.
void setWirePixel(std::uint16_t x, std::uint16_t y, bool on, std::uint8_t* record);

/// Writes one record. \p record must point to kWireEventBytes writable bytes. \pre 0 <= event.t_ns
/// < 2^32 s
void writeWireEvent(const Event& event, std::uint8_t* record);

/// Appends one record to \p bytes. \pre 0 <= event.t_ns < 2^32 s
void encodeWireEvent(const Event& event, std::vector<std::uint8_t>& bytes);

/// Writes \p count records, faster than one by one. \p records must point to room for them. \pre as
/// above, for each
void encodeWireEvents(const Event* events, std::size_t count, std::uint8_t* records);

/// Appends \p count records to \p bytes, faster than one by one. \pre as above, for each
void encodeWireEvents(const Event* events, std::size_t count, std::vector<std::uint8_t>& bytes);

}  // namespace fast_edi
