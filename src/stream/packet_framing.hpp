/// \file
/// What DV sends over a connection: a header, then packets. All numbers are little endian.
///
///     header   u32 size, and that many bytes: a flatbuffer with the identifier IOHE
///     packet   i32 stream, i32 size, and that many bytes, compressed as the header says
///
/// The same as in an AEDAT4 file, without the line at its beginning and the table at its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recording/flatbuffer.hpp"

namespace fast_edi {

/// Cuts the bytes of a connection into header and packets, however they come. Its memory grows as
/// they come, not by the size that somebody claims, and not beyond the largest packet.
class PacketFraming {
 public:
  /// DV's headers have some hundred bytes, or the whole configuration of a camera.
  static constexpr std::size_t kMaxHeaderBytes = std::size_t{4} << 20;
  /// Of a packet as it is sent, and when decompressed: two million events.
  static constexpr std::size_t kMaxPacketBytes = std::size_t{32} << 20;

  struct Room {
    std::uint8_t* data = nullptr;
    std::size_t size = 0;  ///< above 0
  };
  enum class Unit { kNone, kHeader, kPacket };

  PacketFraming();

  /// Where the next bytes belong, never more than the header or packet still lacks. Valid until the
  /// next call of either.
  Room room();
  /// \param count of bytes that were put into room()
  /// \return what they have completed; it is in content() until the next call of room()
  /// \throws StreamError for bytes that are no such header, and for a size that is refused
  Unit add(std::size_t count);

  /// The header with its size in front, or the content of the packet.
  FlatBytes content() const { return {buffer_.data(), filled_}; }
  /// The header is complete: packets follow.
  bool hasHeader() const { return has_header_; }
  /// Number of the packet's stream.
  std::int32_t stream() const { return stream_; }

  /// Bytes of a header or packet that is not complete.
  bool isWithinUnit() const {
    return !complete_ && (filled_ > 0 || state_ == State::kPacketContent);
  }
  /// Throws for a connection that ended, or fell silent, where it should not.
  /// \throws StreamError when what came of a header is none
  void checkHeaderStart() const;

 private:
  enum class State { kHeaderStart, kHeaderContent, kPacketHead, kPacketContent };

  void expect(State state, std::size_t bytes);

  State state_ = State::kHeaderStart;
  std::size_t wanted_ = 0;  ///< bytes of this state
  std::size_t filled_ = 0;
  bool complete_ = false;  ///< content() is a unit that was given
  bool has_header_ = false;
  std::int32_t stream_ = 0;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace fast_edi
