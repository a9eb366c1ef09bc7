#include "fast_edi/events/event_wire.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace fast_edi {
namespace {

constexpr std::size_t kXOffset = 0;
constexpr std::size_t kYOffset = 2;
constexpr std::size_t kSecondsOffset = 4;
constexpr std::size_t kNanosecondsOffset = 8;
constexpr std::size_t kPolarityOffset = 12;
/// Events that are encoded before they are appended.
constexpr std::size_t kEncodedEvents = 256;

// ROS 1 puts numbers on the wire as the host has them, so a copy is the decoding; it also copes
// with records of 13 bytes being aligned to nothing.
template <typename Number>
Number readNumber(const std::uint8_t* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  return number;
}

template <typename Number>
void writeNumber(Number number, std::uint8_t* bytes) {
  std::memcpy(bytes, &number, sizeof(number));
}

}  // namespace

Event decodeWireEvent(const std::uint8_t* record) {
  Event event;
  event.x = readNumber<std::uint16_t>(record + kXOffset);
  event.y = readNumber<std::uint16_t>(record + kYOffset);
  event.t_ns = static_cast<std::int64_t>(readNumber<std::uint32_t>(record + kSecondsOffset)) *
                   kNanosecondsPerSecond +
               readNumber<std::uint32_t>(record + kNanosecondsOffset);
  event.on = record[kPolarityOffset] != 0;
  return event;
}

void setWirePixel(std::uint16_t x, std::uint16_t y, bool on, std::uint8_t* record) {
  writeNumber(x, record + kXOffset);
  writeNumber(y, record + kYOffset);
  record[kPolarityOffset] = on ? 1 : 0;
}

void writeWireEvent(const Event& event, std::uint8_t* record) {
  setWirePixel(event.x, event.y, event.on, record);
  writeNumber(static_cast<std::uint32_t>(event.t_ns / kNanosecondsPerSecond),
              record + kSecondsOffset);
  writeNumber(static_cast<std::uint32_t>(event.t_ns % kNanosecondsPerSecond),
              record + kNanosecondsOffset);
}

void encodeWireEvent(const Event& event, std::vector<std::uint8_t>& bytes) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + kWireEventBytes);
  writeWireEvent(event, bytes.data() + begin);
}

void encodeWireEvents(const Event* events, std::size_t count, std::uint8_t* records) {
  // The second's part is found once for all events within it: a division takes longer than the
  // rest.
  std::int64_t second_ns = 0;
  std::uint32_t second = 0;
  for (const Event* event = events; event != events + count; ++event, records += kWireEventBytes) {
    std::int64_t rest_ns = event->t_ns - second_ns;
    if (rest_ns < 0 || rest_ns >= kNanosecondsPerSecond) {
      second = static_cast<std::uint32_t>(event->t_ns / kNanosecondsPerSecond);
      second_ns = std::int64_t{second} * kNanosecondsPerSecond;
      rest_ns = event->t_ns - second_ns;
    }
    setWirePixel(event->x, event->y, event->on, records);
    writeNumber(second, records + kSecondsOffset);
    writeNumber(static_cast<std::uint32_t>(rest_ns), records + kNanosecondsOffset);
  }
}

void encodeWireEvents(const Event* events, std::size_t count, std::vector<std::uint8_t>& bytes) {
  // By blocks, which are appended as they are: appended room is set to zero first.
  std::array<std::uint8_t, kEncodedEvents * kWireEventBytes> block{};
  for (std::size_t done = 0; done < count;) {
    const std::size_t now = std::min(kEncodedEvents, count - done);
    encodeWireEvents(events + done, now, block.data());
    bytes.insert(bytes.end(), block.data(), block.data() + now * kWireEventBytes);
    done += now;
  }
}

}  // namespace fast_edi
