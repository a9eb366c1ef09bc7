#include "bags/bag_content.hpp"

#include <utility>

#include "bags/chunk_compression.hpp"

namespace fast_edi {
namespace {

/// rosbag refuses record times before the first nanosecond.
ros::Time writableTime(const ros::Time& time) {
  return time < ros::TIME_MIN ? ros::TIME_MIN : time;
}

}  // namespace

BagContent::BagContent(const std::string& path, const std::string& compression)
    : compression_(compression),
      file_(path),
      write_copied_(
          [this](const BagChunk& chunk, const ChunkIndex& index) { copyChunk(chunk, index); }) {}

void BagContent::copyChunksOf(const ChunkSource& source) {
  source_ = &source.file;
  connections_.keep(source.connections);
}

void BagContent::copy(const BagMessage& message) {
  if (source_ != nullptr && message.chunk != nullptr &&
      message.chunk->compression == compression_) {
    copied_.add(message, write_copied_);
    return;
  }
  copied_.endBefore(message.index_time, message.offset, write_copied_);
  if (!chunk_source_) {
    chunk_source_ = message.offset;
  }
  add(connections_.of(*message.connection), message.time, message.data, message.size);
}

void BagContent::write(const BagConnection& connection, const ros::Time& time,
                       const std::uint8_t* data, std::uint32_t size) {
  add(connections_.ofOwn(connection), time, data, size);
}

void BagContent::close() {
  copied_.finish(write_copied_);
  if (!chunk_.empty()) {
    endChunk();
  }
  file_.close(connections_.all());
}

void BagContent::add(const BagConnection& connection, const ros::Time& time,
                     const std::uint8_t* data, std::uint32_t size) {
  if (connections_.isNew(connection)) {
    chunk_.add(connection);
  }
  chunk_.add(connection.id, writableTime(time), data, size);
  if (chunk_.isFull()) {
    endChunk();
  }
}

void BagContent::copyChunk(const BagChunk& chunk, const ChunkIndex& index) {
  if (chunk_source_ && *chunk_source_ < chunk.offset) {
    endChunk();
  }
  file_.copyChunk(*source_, chunk, index);
}

void BagContent::endChunk() {
  chunk_source_.reset();
  const NewChunk chunk = std::exchange(chunk_, {});
  const auto full_size = static_cast<std::uint32_t>(chunk.bytes().size());
  if (compression_ == "none") {
    file_.writeChunk(compression_, full_size, chunk.bytes(), chunk.index());
  } else {
    file_.writeChunk(compression_, full_size, compressChunk(compression_, chunk.bytes()),
                     chunk.index());
  }
}

}  // namespace fast_edi
