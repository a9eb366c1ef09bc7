/// \file
/// What goes into a bag: chunks that are copied, and new ones for all other messages.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <ros/time.h>

#include "bags/bag_file.hpp"
#include "bags/copied_chunks.hpp"
#include "bags/new_chunk.hpp"
#include "bags/written_connections.hpp"
#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// Chunks that are copied and new ones with messages of the same source lie in the order of the
/// source: rosbag's reader for Python takes the messages of a connection as they lie in the file.
///
/// All throw BagError when the file cannot be written.
class BagContent {
 public:
  /// \param compression "none", "bz2" or "lz4"
  BagContent(const std::string& path, const std::string& compression);

  /// \pre nothing was written
  void copyChunksOf(const ChunkSource& source);

  void copy(const BagMessage& message);
  /// \param connection with all but its id and header
  void write(const BagConnection& connection, const ros::Time& time, const std::uint8_t* data,
             std::uint32_t size);
  void close();

 private:
  void add(const BagConnection& connection, const ros::Time& time, const std::uint8_t* data,
           std::uint32_t size);
  void endChunk();
  void copyChunk(const BagChunk& chunk, const ChunkIndex& index);

  const std::string compression_;
  BagFile file_;
  const ByteSource* source_ = nullptr;  ///< of chunks to be copied
  CopiedChunks copied_;
  const CopiedChunks::Write write_copied_;
  NewChunk chunk_;
  std::optional<std::uint64_t> chunk_source_;  ///< where the first message that it copies lies
  WrittenConnections connections_;
};

}  // namespace fast_edi
