/// \file
/// Turns blocks of regular wire records into packed events, several at a time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/events/packed_event.hpp"

namespace fast_edi {

/// Records handled at once; four fit the vector registers of every x86-64.
constexpr std::size_t kWireBlockStride = 4;
/// Bytes that unpackRegularBlock() may read beyond the last record it converts.
constexpr std::size_t kWireBlockOverread = 16 - kWireEventBytes;

/// What makes a block regular.
struct RegularBlock {
  SensorSize size;
  std::uint32_t second = 0;         ///< every record's ts.sec
  std::int32_t second_dt_ns = 0;    ///< start of that second relative to the chunk's base; with any
                                    ///< nanosecond part added it fits 31 bits
  std::int32_t previous_dt_ns = 0;  ///< no record may be older than this
};

/// Converts \p count records (a multiple of kWireBlockStride) into \p out.
/// \return false when some record is not regular: other second, not on the sensor, older than its
///         predecessor, malformed nanoseconds. \p out is then undefined and the records must be
///         taken one by one.
/// \pre count * kWireEventBytes + kWireBlockOverread bytes are readable at \p records
bool unpackRegularBlock(const std::uint8_t* records, std::size_t count, const RegularBlock& block,
                        PackedEvent* out);

}  // namespace fast_edi
