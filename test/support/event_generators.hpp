/// \file
/// Seeded event streams for tests and benchmarks. The same seed gives the same events on every
/// platform (no std distributions). Times never decrease and are whole microseconds, as a DAVIS
/// stamps them, so equal times are common at high rates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"

namespace fast_edi::testing {

/// Extent of a generated stream: `count` events spread over [start, start + duration).
struct EventSpec {
  SensorSize size;
  std::size_t count = 0;
  std::int64_t start_ns = 0;
  std::int64_t duration_ns = 0;
  std::uint64_t seed = 1;
};

enum class EventScene {
  kUniform,      ///< random pixels, random polarity
  kMovingEdges,  ///< straight edges cross the sensor, each pixel's polarity alternates
  kHotPixel,     ///< one pixel in the middle, alternating polarity
  kHotWalk,      ///< one pixel in the middle, random polarity
  kBursts,       ///< short bursts in random patches, one polarity for each burst
  kRandomWalks,  ///< a patch of few pixels with long random polarity walks
};
const char* toString(EventScene scene);

std::vector<Event> makeEvents(EventScene scene, const EventSpec& spec);

/// Wire records, 13 bytes each.
std::vector<std::uint8_t> toWire(const std::vector<Event>& events);
/// View of a whole wire buffer.
WireEvents wireView(const std::vector<std::uint8_t>& bytes);

/// Moves the stamps of all records on. \pre 0 <= by_ns, stamps stay below 2^32 s
void shiftStamps(std::int64_t by_ns, std::uint8_t* records, std::size_t count);
void shiftStamps(std::int64_t by_ns, std::vector<std::uint8_t>& bytes);

/// A reproducible grey image with levels in 20..219 (no saturation at moderate gains).
std::vector<std::uint8_t> makeGreyImage(SensorSize size, std::uint64_t seed);

}  // namespace fast_edi::testing
