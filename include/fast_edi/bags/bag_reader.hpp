/// \file
/// Reads a rosbag 2.0 file in the order of its record times, message by message as raw bytes, also
/// one that is cut short, was never closed or is damaged somewhere inside.
///
/// rosbag::View does the first part for undamaged bags alone: it refuses a file without an index
/// and follows damaged lengths out of its buffers.
///
/// Memory: 24 bytes for each message, the largest message, and decompressed chunks of up to
/// kMaxCachedBytes (at least one).
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <ros/duration.h>
#include <ros/time.h>

#include "fast_edi/bags/bag_chunk.hpp"
#include "fast_edi/bags/bag_index.hpp"
#include "fast_edi/bags/bag_record.hpp"
#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

class BagReader : public MessageSource {
 public:
  static constexpr std::size_t kMaxCachedBytes = std::size_t{64} << 20;

  /// Opens the file and finds its messages.
  /// \throws BagError when it is no rosbag 2.0 file, is encrypted, or cannot be opened
  explicit BagReader(const std::string& path);

  /// The next message in record-time order; false at the end. What cannot be read is skipped and
  /// noted in damage().
  bool next(BagMessage& message) override;

  const std::map<std::uint32_t, BagConnection>& connections() const override {
    return index_.connections;
  }
  /// Damage found so far; all of it once next() has returned false.
  const std::vector<BagDamage>& damage() const override { return index_.damage; }
  /// Messages found.
  std::uint64_t messageCount() const { return index_.entries.size(); }
  /// Messages that next() has come by, readable or not.
  std::uint64_t position() const override { return position_; }
  std::uint64_t length() const override { return messageCount(); }
  bool countsMessages() const override { return true; }
  /// From the first record time to the last.
  ros::Duration duration() const;
  /// Of the first chunk: "none", "bz2" or "lz4".
  std::string compression() const override;
  std::uint64_t fileSize() const override { return file_.size(); }
  std::optional<ChunkSource> chunks() const override {
    return ChunkSource{file_, index_.connections};
  }

 private:
  struct CachedChunk {
    std::uint32_t chunk = 0;
    ChunkBytes bytes;
  };

  const ChunkBytes& decompressed(const BagIndexEntry& entry);
  std::list<CachedChunk>::iterator drop(std::list<CachedChunk>::iterator cached);
  bool read(const BagIndexEntry& entry, BagMessage& message);
  bool readMessage(const ByteSource& source, std::uint64_t offset, BagMessage& message);

  FileSource file_;
  BagIndex index_;
  std::list<CachedChunk> cache_;  ///< most recently used first
  std::size_t cached_bytes_ = 0;
  std::size_t position_ = 0;
  std::vector<std::uint8_t> header_scratch_;
  std::vector<std::uint8_t> data_scratch_;
};

}  // namespace fast_edi
