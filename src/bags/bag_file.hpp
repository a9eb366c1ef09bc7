/// \file
/// A file of the rosbag 2.0 format that grows chunk by chunk
/// (http://wiki.ros.org/Bags/Format/2.0).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "bags/chunk_index.hpp"
#include "fast_edi/bags/bag_index.hpp"
#include "fast_edi/recording/byte_source.hpp"

namespace fast_edi {

/// Until close(), `rosbag reindex` can find all chunks that were written.
///
/// All throw BagError with the system's reason when the file cannot be written.
class BagFile {
 public:
  /// Replaces what is there.
  explicit BagFile(const std::string& path);
  ~BagFile();
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;

  /// \param data compressed
  /// \param full_size of the data before
  void writeChunk(const std::string& compression, std::uint32_t full_size, std::string_view data,
                  const ChunkIndex& index);
  /// The data of a chunk of \p source, byte for byte. Memory: one block of it.
  void copyChunk(const ByteSource& source, const BagChunk& chunk, const ChunkIndex& index);

  /// Writes what readers look for first: the connections, and where the chunks are.
  void close(const std::map<std::uint32_t, BagConnection>& connections);

 private:
  void write(std::string_view bytes);
  void writeChunkHead(const std::string& compression, std::uint32_t full_size, std::uint32_t size);
  void endChunk(std::uint64_t position, const ChunkIndex& index);

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint32_t chunks_ = 0;
  std::string chunk_infos_;
};

/// The record of a connection, as chunks and the end of the file have it.
void appendConnection(std::string& bytes, const BagConnection& connection);

}  // namespace fast_edi
