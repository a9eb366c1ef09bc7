/// \file
/// Packets of an AEDAT4 file: where they lie, their order, and what is in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/raw_bytes.hpp"
#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/aedat4_header.hpp"
#include "recording/flatbuffer.hpp"
#include "recording/packet_compression.hpp"

namespace fast_edi {

struct Aedat4Packet {
  std::uint64_t offset = 0;  ///< of its data in the file
  std::int32_t stream = 0;
  std::uint32_t size = 0;
};

/// Packets one after the other in the order of the file or, where its data table shows that all
/// frames lie before or behind all events, merged by time. Behind damage it goes on at the next
/// bytes that look like a packet.
class Aedat4Packets {
 public:
  /// All of them must outlive this.
  /// \param header whose streams may still be added while they are found by the packets
  /// \param damage takes notes
  Aedat4Packets(const ByteSource& file, const Aedat4Header& header,
                std::vector<RecordingDamage>& damage);

  /// From now on a packet of a stream that the header does not have is damage, unless it has none.
  void requireKnownStreams() { known_streams_required_ = true; }
  /// Reads the data table, if there is one, and merges packets by time where that is needed.
  void readTable();

  /// \return false at the end
  bool next(Aedat4Packet& packet);
  /// Decompresses a packet. \return false when nothing of it is left
  bool load(const Aedat4Packet& packet);
  /// What load() has decompressed; valid until its next call.
  FlatBytes bytes() const { return {buffer_.data(), buffer_.size()}; }
  /// Back to the first packet.
  void rewind();

  /// How far next() has come: bytes in the order of the file, else packets.
  std::uint64_t position() const { return merged_.empty() ? offset_ : merged_done_; }
  /// What position() is at the end.
  std::uint64_t length() const {
    return merged_.empty() ? end_ : static_cast<std::uint64_t>(merged_.size());
  }
  /// For messages.
  std::string expectedStreams() const;

 private:
  void note(std::uint64_t offset, const std::string& what);
  /// Whether the bytes at \p start can be the begin of a packet that ends by \p room.
  bool looksLikePacket(const std::uint8_t* start, std::uint64_t room) const;
  /// The next place from \p from on that looks like a packet; end_ if there is none.
  std::uint64_t findPacket(std::uint64_t from);

  const ByteSource& file_;
  const Aedat4Header& header_;
  std::vector<RecordingDamage>& damage_;
  bool known_streams_required_ = false;
  std::uint64_t offset_ = 0;  ///< of the next packet
  std::uint64_t end_ = 0;     ///< of the packets
  std::vector<Aedat4Packet> merged_;
  std::size_t merged_done_ = 0;
  Decompressor decompressor_;
  std::vector<std::uint8_t> scratch_;
  RawBytes buffer_;
};

}  // namespace fast_edi
