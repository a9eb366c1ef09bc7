#include "recording/event_packet_decoder.hpp"

#include <cstring>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "recording/cdr_reader.hpp"

namespace fast_edi {
namespace {

// libcaer.
constexpr std::size_t kLibcaerBytes = 8;
constexpr std::uint32_t kLibcaerValid = 1;
constexpr std::uint32_t kLibcaerOn = 2;
constexpr unsigned kLibcaerYShift = 2;
constexpr unsigned kLibcaerXShift = 17;
constexpr std::uint32_t kLibcaerSide = 0x7FFF;
constexpr std::uint32_t kLibcaerTime = 0x7FFFFFFF;
constexpr std::uint64_t kLibcaerWrap_us = std::uint64_t{1} << 31;

// mono.
constexpr std::size_t kMonoBytes = 8;

// Words of 16 bits.
constexpr std::size_t kWordBytes = 2;
constexpr unsigned kCodeShift = 12;
constexpr unsigned kPayload = 0xFFF;
constexpr unsigned kTimeBits = 12;
constexpr unsigned kSide = 0x7FF;
constexpr unsigned kPolarity = 0x800;
constexpr unsigned kShortMask = 8;
constexpr unsigned kLongMask = 12;

enum CompressedCode : unsigned {
  kTimeHigh = 0,
  kTimeLow = 1,
  kX = 2,
  kEventAtY = 3,
  kFirstY = 4,
  kMaskOfY = 5
};

enum Evt3Code : unsigned {
  kEvt3Y = 0x0,
  kEvt3EventAtX = 0x2,
  kEvt3FirstX = 0x3,
  kEvt3Mask12 = 0x4,
  kEvt3Mask8 = 0x5,
  kEvt3TimeLow = 0x6,
  kEvt3Continued4 = 0x7,
  kEvt3TimeHigh = 0x8,
  kEvt3Padding = 0x9,
  kEvt3Trigger = 0xA,
  kEvt3Other = 0xE,
  kEvt3Continued12 = 0xF
};
/// The upper part of EVT 3.0's time goes back a little at times; further back, it has wrapped.
constexpr std::uint64_t kEvt3Backwards = 10;
constexpr unsigned kEvt3WrapBits = 24;

template <typename Number>
Number read(const std::uint8_t* bytes, bool big_endian) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  return big_endian ? byteSwapped(number) : number;
}

}  // namespace

std::string EventPacketDecoder::begin(const EventPacket& packet) {
  packet_ = packet;
  place_ = 0;
  untold_ = 0;
  unknown_words_ = 0;
  if (packet.encoding == "libcaer") {
    encoding_ = Encoding::kLibcaer;
    word_bytes_ = kLibcaerBytes;
    libcaer_.high_ns = packet.time_base_ns;
    libcaer_.last_low_us = 0;
  } else if (packet.encoding == "libcaer_cmp") {
    encoding_ = Encoding::kLibcaerCompressed;
    word_bytes_ = kWordBytes;
    word_.time_high_us = word_.time_low_us = 0;
  } else if (packet.encoding == "mono") {
    encoding_ = Encoding::kMono;
    word_bytes_ = kMonoBytes;
  } else if (packet.encoding == "evt3") {
    encoding_ = Encoding::kEvt3;
    word_bytes_ = kWordBytes;
  } else {
    packet_.size = 0;
    return "events in the encoding \"" + std::string(packet.encoding.substr(0, 32)) +
           "\", expected libcaer, libcaer_cmp, mono or evt3";
  }
  const std::size_t rest = packet.size % word_bytes_;
  packet_.size -= rest;
  return rest == 0 ? std::string()
                   : std::to_string(packet.size) + " bytes of events, expected a multiple of " +
                         std::to_string(word_bytes_);
}

bool EventPacketDecoder::decode(std::vector<Event>& events, std::size_t max) {
  const auto run = [&](auto decode_word) {
    for (; place_ < packet_.size && events.size() < max; place_ += word_bytes_) {
      decode_word(packet_.data + place_);
    }
  };
  switch (encoding_) {
    case Encoding::kLibcaer:
      run([&](const std::uint8_t* word) { decodeLibcaer(word, events); });
      break;
    case Encoding::kLibcaerCompressed:
      run([&](const std::uint8_t* word) { decodeCompressed(word, events); });
      break;
    case Encoding::kMono:
      run([&](const std::uint8_t* word) { decodeMono(word, events); });
      break;
    case Encoding::kEvt3:
      run([&](const std::uint8_t* word) { decodeEvt3(word, events); });
      break;
  }
  return place_ < packet_.size;
}

void EventPacketDecoder::add(std::uint64_t t_ns, unsigned x, unsigned y, bool on,
                             std::vector<Event>& events) {
  if (t_ns > static_cast<std::uint64_t>(kLastStamp_ns)) {
    ++untold_;
    return;
  }
  events.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                    static_cast<std::int64_t>(t_ns), on});
}

void EventPacketDecoder::decodeLibcaer(const std::uint8_t* word, std::vector<Event>& events) {
  const auto data = read<std::uint32_t>(word, packet_.big_endian);
  const std::uint32_t low_us =
      read<std::uint32_t>(word + sizeof(data), packet_.big_endian) & kLibcaerTime;
  if ((data & kLibcaerValid) == 0) {
    return;
  }
  // Times may lie a little behind one another; a wrap takes them back by nearly all there is.
  if (libcaer_.last_low_us > low_us && libcaer_.last_low_us - low_us > kLibcaerWrap_us / 2) {
    libcaer_.high_ns += kLibcaerWrap_us * kNanosecondsPerMicrosecond;
  }
  libcaer_.last_low_us = low_us;
  add(libcaer_.high_ns + low_us * kNanosecondsPerMicrosecond,
      (data >> kLibcaerXShift) & kLibcaerSide, (data >> kLibcaerYShift) & kLibcaerSide,
      (data & kLibcaerOn) != 0, events);
}

void EventPacketDecoder::decodeMono(const std::uint8_t* word, std::vector<Event>& events) {
  constexpr unsigned kMonoXShift = 32;
  constexpr unsigned kMonoYShift = 48;
  constexpr unsigned kMonoOnShift = 63;
  constexpr std::uint64_t kMonoTime = 0xFFFFFFFF;
  constexpr std::uint64_t kMonoX = 0xFFFF;
  constexpr std::uint64_t kMonoY = 0x7FFF;
  const auto data = read<std::uint64_t>(word, packet_.big_endian);
  add(packet_.time_base_ns + (data & kMonoTime),
      static_cast<unsigned>((data >> kMonoXShift) & kMonoX),
      static_cast<unsigned>((data >> kMonoYShift) & kMonoY), (data >> kMonoOnShift) != 0, events);
}

std::uint64_t EventPacketDecoder::wordTime() const {
  return (word_.time_high_us + word_.time_low_us) * kNanosecondsPerMicrosecond;
}

void EventPacketDecoder::addMask(unsigned mask, unsigned count, bool along_x,
                                 std::vector<Event>& events) {
  const std::uint64_t base_ns = along_x ? evt3_offset_ns_.value_or(0) : packet_.time_base_ns;
  unsigned& side = along_x ? word_.x : word_.y;
  for (unsigned i = 0; i < count; ++i, ++side) {
    if ((mask >> i & 1) != 0) {
      add(base_ns + wordTime(), word_.x, word_.y, word_.on, events);
    }
  }
  side &= kPayload;  // beyond any sensor, but within 16 bits
}

void EventPacketDecoder::decodeCompressed(const std::uint8_t* word, std::vector<Event>& events) {
  const auto data = read<std::uint16_t>(word, packet_.big_endian);
  const unsigned payload = data & kPayload;
  switch (data >> kCodeShift) {
    case kTimeHigh:
      word_.time_high_us = std::uint64_t{payload} << kTimeBits;
      break;
    case kTimeLow:
      word_.time_low_us = payload;
      break;
    case kX:
      word_.x = payload & kSide;
      break;
    case kEventAtY:
      add(packet_.time_base_ns + wordTime(), word_.x, payload & kSide, (payload & kPolarity) != 0,
          events);
      break;
    case kFirstY:
      word_.y = payload & kSide;
      word_.on = (payload & kPolarity) != 0;
      break;
    case kMaskOfY:
      addMask(payload, kShortMask, false, events);
      break;
    default:
      ++unknown_words_;
  }
}

void EventPacketDecoder::setEvt3High(std::uint64_t high) {
  const std::uint64_t last = word_.time_high_us >> kTimeBits & kPayload;
  std::uint64_t wraps_us = word_.time_high_us >> kEvt3WrapBits << kEvt3WrapBits;
  if (word_.has_high && high < last && last - high > kEvt3Backwards) {
    wraps_us += std::uint64_t{1} << kEvt3WrapBits;
  }
  word_.time_high_us = wraps_us + (high << kTimeBits);
  word_.has_high = true;
}

void EventPacketDecoder::decodeEvt3(const std::uint8_t* word, std::vector<Event>& events) {
  const auto data = read<std::uint16_t>(word, packet_.big_endian);
  const unsigned payload = data & kPayload;
  const unsigned code = data >> kCodeShift;
  switch (code) {
    case kEvt3TimeHigh:
      setEvt3High(payload);
      return;
    case kEvt3TimeLow:
      word_.time_low_us = payload;
      word_.has_time = word_.has_high;
      return;
    case kEvt3Y:
      word_.y = payload & kSide;
      return;
    case kEvt3FirstX:
      word_.x = payload & kSide;
      word_.on = (payload & kPolarity) != 0;
      return;
    case kEvt3EventAtX:
    case kEvt3Mask12:
    case kEvt3Mask8:
      break;
    case kEvt3Continued4:
    case kEvt3Padding:
    case kEvt3Trigger:
    case kEvt3Other:
    case kEvt3Continued12:
      return;
    default:
      ++unknown_words_;
      return;
  }
  if (!word_.has_time) {
    return;  // the recording began in the middle: the camera tells its time soon
  }
  if (!evt3_offset_ns_) {
    evt3_offset_ns_ = static_cast<std::uint64_t>(packet_.stamp_ns) - wordTime();
  }
  if (code == kEvt3EventAtX) {
    add(*evt3_offset_ns_ + wordTime(), payload & kSide, word_.y, (payload & kPolarity) != 0,
        events);
  } else {
    addMask(payload, code == kEvt3Mask12 ? kLongMask : kShortMask, true, events);
  }
}

}  // namespace fast_edi
