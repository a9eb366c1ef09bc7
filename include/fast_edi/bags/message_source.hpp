/// \file
/// A recording as ROS messages, whatever its format.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <ros/time.h>

#include "fast_edi/bags/bag_index.hpp"

namespace fast_edi {

/// A message; `data` is valid until the next call of MessageSource::next().
struct BagMessage {
  const BagConnection* connection = nullptr;
  ros::Time time;  ///< record time
  /// That of a bag's index, as BagIndexEntry has it, in whose order messages come; `time` is
  /// another one where it had to be put right.
  std::uint64_t index_time = 0;
  const std::uint8_t* data = nullptr;
  std::uint32_t size = 0;
  std::uint64_t offset = 0;  ///< in its file; of its chunk where that is compressed
  bool decoded = false;      ///< made of the message before it: not in the recording itself
  /// A compressed one that the message may be copied with; null: none. See MessageSource::chunks().
  const BagChunk* chunk = nullptr;
  std::uint32_t place = 0;  ///< of the message's record in the decompressed chunk
};

/// A bag whose compressed chunks can be copied into another one as they are. (Others could be, too,
/// but it takes as long as writing their messages.)
struct ChunkSource {
  const ByteSource& file;
  const std::map<std::uint32_t, BagConnection>& connections;  ///< of the ids that the chunks use
};

class MessageSource {
 public:
  MessageSource() = default;
  virtual ~MessageSource() = default;
  MessageSource(const MessageSource&) = delete;
  MessageSource& operator=(const MessageSource&) = delete;

  /// The next message in record-time order; false at the end. What cannot be read is skipped and
  /// noted in damage().
  virtual bool next(BagMessage& message) = 0;
  /// By id; known from the start.
  virtual const std::map<std::uint32_t, BagConnection>& connections() const = 0;
  /// Damage found so far; all of it once next() has returned false.
  virtual const std::vector<BagDamage>& damage() const = 0;
  /// How far next() has come, in units of the source's own.
  virtual std::uint64_t position() const = 0;
  /// What position() is at the end.
  virtual std::uint64_t length() const = 0;
  /// Whether length() is the number of messages.
  virtual bool countsMessages() const { return false; }
  /// Of a bag: "none", "bz2" or "lz4".
  virtual std::string compression() const { return "none"; }
  virtual std::uint64_t fileSize() const = 0;
  /// Where the chunks of messages are; nothing: they cannot be copied. May be read by other threads
  /// than next().
  virtual std::optional<ChunkSource> chunks() const { return std::nullopt; }
  /// The stamp of each frame is the middle of an exposure that was recorded.
  virtual bool knowsExposures() const { return false; }
  /// Bias settings of the camera, where the recording holds them.
  virtual std::optional<BiasConfiguration> biases() const { return std::nullopt; }
};

}  // namespace fast_edi
