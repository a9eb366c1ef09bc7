/// \file
/// Decompression of rosbag chunks that may be cut or damaged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace fast_edi {

/// A decompressed chunk, or what could be had of it.
struct ChunkBytes {
  std::unique_ptr<std::uint8_t[]> data;
  std::size_t size = 0;   ///< bytes that were decompressed
  bool complete = false;  ///< all of them
  /// Complete, and rosbag's own decoders agree: they want nothing behind the compressed data, and
  /// know but a part of what lz4's frames may have.
  bool copyable = false;
};

/// True for the compressions that rosbag knows: "none", "bz2", "lz4".
bool isKnownCompression(std::string_view compression);

/// Decompresses "bz2" or "lz4" up to the first damage: both have blocks (bz2 of 900 kB, lz4 of 1 MB
/// in rosbag), and those before it are returned.
/// \param full_size what the chunk's header says of the size after decompression; 0 = not known,
///        as in a recording that was killed
/// \throws std::bad_alloc
ChunkBytes decompressChunk(std::string_view compression, const std::uint8_t* data, std::size_t size,
                           std::size_t full_size);

}  // namespace fast_edi
