/// \file
/// What lies where in a rosbag 2.0 file, also in one that is cut short, was never closed or is
/// damaged somewhere inside.
///
/// The file is walked record by record. The index that rosbag writes behind each chunk is taken
/// where it is whole; a chunk without one is searched itself. After damage the walk goes on at the
/// next chunk record.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <ros/datatypes.h>
#include <boost/shared_ptr.hpp>

#include "fast_edi/bags/bag_chunk.hpp"
#include "fast_edi/bags/bag_record.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// A topic of one publisher, as recorded.
struct BagConnection {
  std::uint32_t id = 0;
  std::string topic;
  std::string datatype;
  std::string md5sum;
  std::string definition;
  boost::shared_ptr<ros::M_string> header;  ///< all fields, as rosbag stores them
  std::uint64_t messages = 0;               ///< in the index; some may prove unreadable
  bool counted = true;  ///< false: messages is 1, however many there will prove to be
};

using BagDamage = RecordingDamage;

/// Where a chunk's data lie.
struct BagChunk {
  std::uint64_t offset = 0;     ///< in the file
  std::uint64_t size = 0;       ///< in the file
  std::uint32_t full_size = 0;  ///< decompressed, as stated; 0 = not known
  std::string compression;      ///< "none", "bz2" or "lz4"
  bool cut = false;             ///< it ends early: `size` is a guess
  std::uint64_t last_time = 0;  ///< of its messages in the index, as BagIndexEntry has it

  bool compressed() const { return compression != "none"; }
};

/// Where a message lies.
struct BagIndexEntry {
  std::uint64_t time = 0;    ///< record time: seconds << 32 | nanoseconds
  std::uint64_t offset = 0;  ///< of the message's record in the decompressed chunk
  std::uint32_t chunk = 0;   ///< index into BagIndex::chunks
};

struct BagIndex {
  std::map<std::uint32_t, BagConnection> connections;  ///< by id
  std::vector<BagChunk> chunks;                        ///< in file order
  std::vector<BagIndexEntry> entries;  ///< in order of time; of equal times as in the file
  std::vector<BagDamage> damage;       ///< in file order
};

/// \param path for messages alone
/// \throws BagError when \p file is no rosbag 2.0 file or is encrypted
BagIndex buildBagIndex(const ByteSource& file, const std::string& path);

/// The chunk's bytes as \p file has them, decompressed as far as possible.
ChunkBytes readChunk(const ByteSource& file, const BagChunk& chunk);

}  // namespace fast_edi
