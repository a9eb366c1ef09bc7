/// \file
/// Which messages of a chunk are in a bag, and where they lie in it.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include <ros/time.h>

namespace fast_edi {

/// What rosbag's readers find messages by: a message that is not in here does not exist for them.
class ChunkIndex {
 public:
  /// \param offset of the message's record in the decompressed chunk
  void add(std::uint32_t connection, const ros::Time& time, std::uint32_t offset);

  /// The records that follow the chunk: one of each connection.
  void appendRecords(std::string& bytes) const;
  /// The record at the end of the bag that says where the chunk is.
  /// \param position of the chunk's record in the file
  void appendChunkInfo(std::string& bytes, std::uint64_t position) const;

 private:
  struct Entries {
    std::uint32_t count = 0;
    std::string bytes;  ///< time and offset of each
  };

  std::map<std::uint32_t, Entries> connections_;
  ros::Time first_ = ros::TIME_MAX;
  ros::Time last_;
};

}  // namespace fast_edi
