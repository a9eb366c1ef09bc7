/// \file
/// Writes a bag that appears under its name only when it is complete.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include "fast_edi/bags/file_lock.hpp"
#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

class BagContent;

/// What becomes of PATH.active when the bag was not completed.
enum class UnfinishedBag {
  kKeep,  ///< it stays, so that `rosbag reindex` can save what it holds
  /// It is removed. What another process that was killed has left is replaced; what one is still
  /// writing is refused.
  kRemove,
};

/// Writes to PATH.active, renamed to PATH by close().
///
/// Not by rosbag::Bag: that compresses every message, also those which lie in the input compressed
/// the same way already. Memory: a chunk of 768 kB, or the largest message.
class BagWriter {
 public:
  /// \param inputs the recordings that are being read: refused as an output
  /// \param compression "none", "bz2" or "lz4"
  /// \param overwrite replace \p path and PATH.active if they exist
  /// \throws BagError for a path that cannot or may not be written
  BagWriter(const std::string& path, const std::vector<std::string>& inputs,
            const std::string& compression, bool overwrite,
            UnfinishedBag unfinished = UnfinishedBag::kKeep);
  /// Leaves PATH.active behind, or removes it, when close() was not reached.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// From now on, copy() takes whole chunks of the source as they are, where they are compressed as
  /// the output. They lie in the order of the source then, those of other topics before or behind
  /// them: rosbag's readers expect no more.
  /// \param source of all messages that are copied; must outlive this object
  /// \pre nothing was written yet
  void copyChunksOf(const ChunkSource& source);

  /// The same bytes under the same topic, type and connection header at the same record time.
  /// \param message of the same source as all others
  /// \throws BagError
  void copy(const BagMessage& message);

  /// A message of ours.
  /// \throws BagError
  template <typename Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message) {
    namespace traits = ros::message_traits;
    bytes_.resize(ros::serialization::serializationLength(message));
    ros::serialization::OStream stream(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    stream.next(message);
    BagConnection connection;
    connection.topic = topic;
    connection.datatype = traits::datatype(message);
    connection.md5sum = traits::md5sum(message);
    connection.definition = traits::definition(message);
    writeBytes(connection, time);
  }

  /// Writes the index and gives the file its name.
  /// \throws BagError
  void close();

 private:
  void writeBytes(const BagConnection& connection, const ros::Time& time);
  template <typename Action>
  void guarded(Action action);
  [[noreturn]] void fail(const std::exception& error);

  void requireFree(const std::vector<std::string>& inputs, bool overwrite) const;
  void claim();
  void removeUnfinished();

  const std::string path_;
  const std::string active_path_;
  const UnfinishedBag unfinished_;
  FileLock lock_;  ///< of active_path_, while it is to be removed
  std::unique_ptr<BagContent> content_;
  std::vector<std::uint8_t> bytes_;  ///< of a message of ours
};

}  // namespace fast_edi
