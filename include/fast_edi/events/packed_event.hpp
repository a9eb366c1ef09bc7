/// \file
/// The log's events as they lie in memory: 8 bytes each.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fast_edi {

/// One event as the log stores it.
struct PackedEvent {
  std::uint32_t dt_ns;  ///< time since the base of its chunk [ns]
  std::uint32_t code;   ///< 2 * (y * width + x) + (ON ? 1 : 0)
};

/// Consecutive events of the log, for stages that walk it.
struct PackedEventSpan {
  const PackedEvent* data = nullptr;
  const std::uint16_t* intervals = nullptr;  ///< see EventIntervals; null unless they are kept
  std::size_t count = 0;
  std::int64_t base_ns = 0;          ///< add dt_ns for sensor time
  std::uint64_t first_sequence = 0;  ///< sequence number of data[0]
};

}  // namespace fast_edi
