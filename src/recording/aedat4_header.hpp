/// \file
/// What an AEDAT4 file says of itself before its first packet, and behind its last one.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/flatbuffer.hpp"
#include "recording/packet_compression.hpp"

namespace fast_edi {

constexpr std::size_t kAedat4PacketHeaderBytes = 8;  ///< i32 stream, i32 size
constexpr int kAedat4MaxSide_px = 32767;             ///< fields of 16 bits with a sign
constexpr char kAedat4Events[] = "EVTS";
constexpr char kAedat4Frames[] = "FRME";
constexpr char kAedat4Imu[] = "IMUS";
constexpr char kAedat4Triggers[] = "TRIG";
constexpr char kAedat4Header[] = "IOHE";
constexpr char kAedat4Table[] = "FTAB";

/// A packet's place by the data table.
struct Aedat4TableEntry {
  std::uint64_t offset = 0;  ///< in the file, of the packet's data
  std::int32_t stream = 0;
  std::uint32_t size = 0;
  std::int64_t end_us = 0;  ///< latest time in it
};

struct Aedat4Header {
  Compression compression = Compression::kNone;
  std::uint64_t first_packet = 0;           ///< offset in the file
  std::optional<std::uint64_t> data_table;  ///< offset in the file; nothing when there is none
  std::map<std::int32_t, RecordedStream> streams;  ///< by the number that packets name
  std::optional<BiasConfiguration> biases;
  std::vector<std::string> faults;  ///< of the streams' description
};

/// Compression, streams and biases; places in a file are left as they are.
/// \param io_header with its size in front
/// \param header set unless something is wrong
/// \return what is wrong; empty if nothing is
std::string decodeAedat4Header(FlatBytes io_header, Aedat4Header& header);

/// \throws RecordingError
Aedat4Header readAedat4Header(const ByteSource& file, const std::string& path);

/// The data table; nothing when it cannot be read.
/// \pre header.data_table
std::optional<std::vector<Aedat4TableEntry>> readAedat4Table(const ByteSource& file,
                                                             const Aedat4Header& header,
                                                             Decompressor& decompressor);

}  // namespace fast_edi
