/// What a server of streams may send: the input is the bytes of a connection behind one byte, which
/// says in what pieces they come and what is expected.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <variant>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fuzz/fuzzing.hpp"
#include "stream/packet_framing.hpp"
#include "stream/stream_decoder.hpp"
#include "stream/stream_error.hpp"

namespace {

using fast_edi::PacketFraming;
using fast_edi::StreamKind;
using fast_edi::fuzzing::require;

/// Touches each byte that an item points to.
std::size_t sumOf(const fast_edi::RecordingItem& item) {
  std::size_t sum = 0;
  if (const auto* events = std::get_if<fast_edi::RecordedEvents>(&item.content)) {
    for (std::size_t i = 0; i < events->count; ++i) {
      require(fast_edi::isStamp(events->data[i].t_ns), "times of events can be stamped");
      sum += events->data[i].x;
    }
  } else if (const auto* frame = std::get_if<fast_edi::RecordedFrame>(&item.content)) {
    require(fast_edi::isStamp(frame->stamp_ns), "times of frames can be stamped");
    require(frame->size.width > 0 && frame->size.height > 0, "frames have a size");
    for (std::size_t i = 0; i < frame->bytes; ++i) {
      sum += frame->pixels[i];
    }
  }
  return sum;
}

void receive(const std::uint8_t* data, std::size_t size, std::size_t piece, StreamKind kind) {
  PacketFraming framing;
  std::unique_ptr<fast_edi::StreamDecoder> decoder;
  std::size_t sum = 0;
  for (std::size_t done = 0; done < size;) {
    const PacketFraming::Room room = framing.room();
    require(room.size > 0, "there is room for the next byte");
    const std::size_t count = std::min({room.size, piece, size - done});
    std::memcpy(room.data, data + done, count);
    done += count;
    const PacketFraming::Unit unit = framing.add(count);
    if (unit == PacketFraming::Unit::kHeader) {
      require(!decoder, "there is one header");
      decoder = std::make_unique<fast_edi::StreamDecoder>(framing.content(), kind);
    } else if (unit == PacketFraming::Unit::kPacket) {
      require(decoder != nullptr, "packets come behind the header");
      require(framing.content().size <= size, "a packet is no larger than what was sent");
      decoder->open(framing.stream(), framing.content());
      fast_edi::RecordingItem item;
      while (decoder->next(item)) {
        sum += sumOf(item);
      }
      for (const fast_edi::RecordingDamage& damage : decoder->takeDamage()) {
        require(!damage.what.empty(), "damage says what it is");
      }
    }
  }
  framing.checkHeaderStart();
  require(sum < SIZE_MAX, "all was read");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  constexpr StreamKind kKinds[] = {StreamKind::kEvents, StreamKind::kFrames, StreamKind::kImu,
                                   StreamKind::kTriggers};
  constexpr std::size_t kPieces[] = {1, 7, 4096, SIZE_MAX};
  try {
    receive(data + 1, size - 1, kPieces[data[0] / 4 % 4], kKinds[data[0] % 4]);
  } catch (const fast_edi::StreamError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
  return 0;
}
