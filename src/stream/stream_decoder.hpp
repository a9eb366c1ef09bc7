/// \file
/// From header and packets of a connection to their items.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "fast_edi/base/raw_bytes.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/aedat4_packet_decoder.hpp"
#include "recording/flatbuffer.hpp"
#include "recording/packet_compression.hpp"

namespace fast_edi {

class StreamDecoder {
 public:
  /// \param io_header with its size in front
  /// \param expected what the connection is for
  /// \throws StreamError when that is not what the header says, or it cannot be used
  StreamDecoder(FlatBytes io_header, StreamKind expected);
  StreamDecoder(const StreamDecoder&) = delete;
  StreamDecoder& operator=(const StreamDecoder&) = delete;

  /// The stream that was expected.
  const RecordedStream& stream() const { return streams_[main_]; }

  /// Begins a packet. \param data as it was sent, valid until the next call
  void open(std::int32_t stream, FlatBytes data);
  /// The next item of the packet, of stream(). \return false when there is none left
  bool next(RecordingItem& item);

  /// What was wrong since the last call; what could not be read was left out.
  std::vector<RecordingDamage> takeDamage();

 private:
  std::vector<RecordedStream> streams_;
  std::map<std::int32_t, std::size_t> numbers_;  ///< from the packets' numbers to streams_
  std::size_t main_ = 0;
  Compression compression_ = Compression::kNone;
  std::uint64_t packets_ = 0;
  bool is_open_ = false;
  std::vector<RecordingDamage> damage_;
  RawBytes plain_;
  Decompressor decompressor_;
  Aedat4PacketDecoder decoder_;
};

/// "events", "frames", "IMU samples", "triggers".
const char* toString(StreamKind kind);

}  // namespace fast_edi
