#include "support/array_kinds.hpp"

#include <algorithm>

#include "fast_edi/events/event_wire.hpp"

namespace fast_edi::testing {
namespace {

constexpr std::int64_t kStep_ns = 40;
constexpr std::int64_t kBack_ns = kNanosecondsPerSecond;
constexpr std::int64_t kAhead_ns = 20 * kNanosecondsPerSecond;
constexpr std::int64_t kTooth = 100;  ///< events

std::int64_t timeAfterStart(ArrayKind kind, std::int64_t i) {
  switch (kind) {
    case ArrayKind::kFalling:
      return -i * kBack_ns;
    case ArrayKind::kFallingTeeth:
      return i * kStep_ns - i / kTooth * kBack_ns;
    case ArrayKind::kLate:
      return -i * kNanosecondsPerMicrosecond;
    case ArrayKind::kAlternating:
      return i * kStep_ns - i % 2 * kBack_ns;
    case ArrayKind::kRepeated:
      return 0;
    case ArrayKind::kFarAhead:
      return i * kAhead_ns;
    case ArrayKind::kStrays:
      return i * kStep_ns + i % 2 * kAhead_ns;
    case ArrayKind::kRegular:
    case ArrayKind::kOnePixel:
    case ArrayKind::kOutside:
      break;
  }
  return i * kStep_ns;
}

}  // namespace

const char* toString(ArrayKind kind) {
  switch (kind) {
    case ArrayKind::kRegular:
      return "regular";
    case ArrayKind::kFalling:
      return "falling";
    case ArrayKind::kFallingTeeth:
      return "falling_teeth";
    case ArrayKind::kLate:
      return "late";
    case ArrayKind::kAlternating:
      return "alternating";
    case ArrayKind::kRepeated:
      return "repeated";
    case ArrayKind::kFarAhead:
      return "far_ahead";
    case ArrayKind::kStrays:
      return "strays";
    case ArrayKind::kOnePixel:
      return "one_pixel";
    case ArrayKind::kOutside:
      return "outside";
  }
  return "unknown kind";
}

std::vector<std::uint8_t> makeArray(ArrayKind kind, SensorSize size, std::size_t count,
                                    std::int64_t start_ns) {
  std::vector<std::uint8_t> records;
  records.reserve(count * kWireEventBytes);
  std::uint32_t random = 1;
  for (std::size_t i = 0; i < count; ++i) {
    random = random * 1664525u + 1013904223u;  // Numerical Recipes' generator
    const auto pixel = static_cast<int>((random >> 8) % size.pixelCount());
    Event event;
    event.x = static_cast<std::uint16_t>(pixel % size.width);
    event.y = static_cast<std::uint16_t>(pixel / size.width);
    event.on = (random >> 7 & 1u) != 0;
    event.t_ns = start_ns + timeAfterStart(kind, static_cast<std::int64_t>(i));
    if (kind == ArrayKind::kOnePixel) {
      event.x = event.y = 0;
    } else if (kind == ArrayKind::kOutside) {
      event.x = static_cast<std::uint16_t>(size.width);
    }
    encodeWireEvent(event, records);
  }
  return records;
}

}  // namespace fast_edi::testing
