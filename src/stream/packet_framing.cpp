#include "stream/packet_framing.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "recording/aedat4_header.hpp"
#include "recording/number_at.hpp"
#include "stream/foreign_protocol.hpp"
#include "stream/stream_error.hpp"

namespace fast_edi {
namespace {

/// Room is made in steps of this, or doubled.
constexpr std::size_t kStepBytes = std::size_t{64} << 10;
/// u32 size, u32 place of the root table, identifier.
constexpr std::size_t kHeaderStartBytes = 12;
constexpr std::size_t kIdentifierPlace = 8;
constexpr std::string_view kIdentifier = kAedat4Header;

}  // namespace

PacketFraming::PacketFraming() {
  expect(State::kHeaderStart, kHeaderStartBytes);
}

void PacketFraming::expect(State state, std::size_t bytes) {
  state_ = state;
  wanted_ = bytes;
}

PacketFraming::Room PacketFraming::room() {
  if (complete_) {
    complete_ = false;
    filled_ = 0;
    expect(State::kPacketHead, kAedat4PacketHeaderBytes);
  }
  if (buffer_.size() <= filled_) {
    buffer_.resize(std::max(filled_ + kStepBytes, std::min(2 * filled_, wanted_)));
  }
  return {buffer_.data() + filled_, std::min(wanted_, buffer_.size()) - filled_};
}

PacketFraming::Unit PacketFraming::add(std::size_t count) {
  filled_ += count;
  if (filled_ < wanted_) {
    return Unit::kNone;
  }
  switch (state_) {
    case State::kHeaderStart: {
      checkHeaderStart();
      const std::size_t size = numberAt<std::uint32_t>(buffer_.data());
      if (size < kHeaderStartBytes || size > kMaxHeaderBytes) {
        throw StreamError("a header of " + std::to_string(size) + " bytes, expected " +
                          std::to_string(kHeaderStartBytes) + ".." +
                          std::to_string(kMaxHeaderBytes));
      }
      expect(State::kHeaderContent, sizeof(std::uint32_t) + size);
      return Unit::kNone;
    }
    case State::kPacketHead: {
      stream_ = numberAt<std::int32_t>(buffer_.data());
      const auto size = numberAt<std::int32_t>(buffer_.data() + sizeof(stream_));
      if (size <= 0 || static_cast<std::size_t>(size) > kMaxPacketBytes) {
        throw StreamError("a packet of stream " + std::to_string(stream_) + " with " +
                          std::to_string(size) + " bytes, expected 1.." +
                          std::to_string(kMaxPacketBytes));
      }
      filled_ = 0;
      expect(State::kPacketContent, static_cast<std::size_t>(size));
      return Unit::kNone;
    }
    case State::kHeaderContent:
      has_header_ = true;
      complete_ = true;
      return Unit::kHeader;
    case State::kPacketContent:
      break;
  }
  complete_ = true;
  return Unit::kPacket;
}

void PacketFraming::checkHeaderStart() const {
  if (state_ != State::kHeaderStart || filled_ == 0) {
    return;
  }
  const std::string_view bytes(reinterpret_cast<const char*>(buffer_.data()), filled_);
  if (bytes.size() < kHeaderStartBytes || bytes.substr(kIdentifierPlace) != kIdentifier) {
    throw StreamError("expected the header of a stream of DV, got " + describeForeign(bytes));
  }
}

}  // namespace fast_edi
