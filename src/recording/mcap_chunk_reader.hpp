/// \file
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/raw_bytes.hpp"
#include "fast_edi/recording/byte_source.hpp"
#include "recording/mcap_records.hpp"
#include "recording/packet_compression.hpp"

namespace fast_edi {

/// Reads, decompresses and checks chunks of an MCAP file.
class McapChunkReader {
 public:
  /// \param file must outlive this
  explicit McapChunkReader(const ByteSource& file) : file_(file) {}

  /// \param chunk in the file, no larger than Rosbag2Storage::kMaxMessageBytes
  /// \param records what came of it; also where something is wrong, as far as it goes
  /// \return what is wrong; empty if nothing is
  std::string read(const McapRecord& chunk, RawBytes& records);

 private:
  const ByteSource& file_;
  Decompressor decompressor_;
  std::vector<std::uint8_t> scratch_;
};

}  // namespace fast_edi
