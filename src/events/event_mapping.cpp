#include "fast_edi/events/event_mapping.hpp"

#include "fast_edi/events/event_wire.hpp"

namespace fast_edi {
namespace {

/// Each orientation is an exchange of the axes, or none, and then a mirroring of each of them.
struct Steps {
  bool exchange = false;
  bool mirror_x = false;
  bool mirror_y = false;
};

Steps stepsOf(EventOrientation orientation) {
  switch (orientation) {
    case EventOrientation::kFlipX:
      return {false, true, false};
    case EventOrientation::kFlipY:
      return {false, false, true};
    case EventOrientation::kRotate180:
      return {false, true, true};
    case EventOrientation::kTranspose:
      return {true, false, false};
    case EventOrientation::kRotate90:
      return {true, true, false};
    case EventOrientation::kRotate270:
      return {true, false, true};
    case EventOrientation::kTransverse:
      return {true, true, true};
    case EventOrientation::kNormal:
      break;
  }
  return {};
}

/// Modulo 2^16, which takes what is not below \p side to what is not either.
std::uint16_t mirrored(std::uint16_t coordinate, int side) {
  return static_cast<std::uint16_t>(side - 1 - coordinate);
}

}  // namespace

SensorSize EventMapping::apply(SensorSize size) const {
  return stepsOf(orientation).exchange ? SensorSize{size.height, size.width} : size;
}

Event EventMapping::apply(Event event, SensorSize size) const {
  const Steps steps = stepsOf(orientation);
  const SensorSize mapped = apply(size);
  if (steps.exchange) {
    std::swap(event.x, event.y);
  }
  event.x = steps.mirror_x ? mirrored(event.x, mapped.width) : event.x;
  event.y = steps.mirror_y ? mirrored(event.y, mapped.height) : event.y;
  event.on = event.on != (polarity == EventPolarity::kInverted);
  return event;
}

void EventMapping::apply(std::uint8_t* records, std::size_t count, SensorSize size) const {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t* record = records + i * kWireEventBytes;
    const Event event = apply(decodeWireEvent(record), size);
    setWirePixel(event.x, event.y, event.on, record);
  }
}

const char* toString(EventOrientation orientation) {
  for (const auto& [word, value] : kEventOrientations) {
    if (value == orientation) {
      return word;
    }
  }
  return "";
}

}  // namespace fast_edi
