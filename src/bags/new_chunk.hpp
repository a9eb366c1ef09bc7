/// \file
/// A chunk of a bag as it is put together, not compressed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <ros/time.h>

#include "bags/chunk_index.hpp"
#include "fast_edi/bags/bag_index.hpp"

namespace fast_edi {

class NewChunk {
 public:
  /// Says who publishes the messages that follow.
  /// \throws BagError when the chunk would have 4 GiB
  void add(const BagConnection& connection);
  /// \param connection id
  /// \throws BagError when the chunk would have 4 GiB
  void add(std::uint32_t connection, const ros::Time& time, const std::uint8_t* data,
           std::uint32_t size);

  bool empty() const { return bytes_.empty(); }
  /// It is time to write it: 768 kB, as rosbag has it.
  bool isFull() const { return bytes_.size() > kFullBytes; }

  const std::string& bytes() const { return bytes_; }
  const ChunkIndex& index() const { return index_; }

 private:
  static constexpr std::size_t kFullBytes = std::size_t{768} * 1024;

  void requireRoom(std::size_t more) const;

  std::string bytes_;
  ChunkIndex index_;
};

}  // namespace fast_edi
