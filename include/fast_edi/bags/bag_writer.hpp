/// \file
/// Writes a bag that appears under its name only when it is complete.
#pragma once

#include <cerrno>
#include <memory>
#include <string>
#include <vector>

#include <ros/time.h>
#include <rosbag/bag.h>

#include "fast_edi/bags/file_lock.hpp"
#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// What becomes of PATH.active when the bag was not completed.
enum class UnfinishedBag {
  kKeep,  ///< it stays, so that `rosbag reindex` can save what it holds
  /// It is removed. What another process that was killed has left is replaced; what one is still
  /// writing is refused.
  kRemove,
};

/// rosbag::Bag writing to PATH.active, renamed to PATH by close().
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

  /// The same bytes under the same topic, type and connection header at the same record time.
  /// \throws BagError
  void copy(const BagMessage& message);

  /// A message of ours.
  /// \throws BagError
  template <typename Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message) {
    guarded([&] { bag_->write(topic, writableTime(time), message); });
  }

  /// Writes the index and gives the file its name.
  /// \throws BagError
  void close();

 private:
  /// rosbag refuses record times before the first nanosecond.
  static ros::Time writableTime(const ros::Time& time) {
    return time < ros::TIME_MIN ? ros::TIME_MIN : time;
  }

  template <typename Action>
  void guarded(Action action) {
    errno = 0;
    try {
      action();
    } catch (const std::exception& error) {
      fail(error);
    }
  }
  [[noreturn]] void fail(const std::exception& error);

  void requireFree(const std::vector<std::string>& inputs, bool overwrite) const;
  void claim();

  const std::string path_;
  const std::string active_path_;
  const UnfinishedBag unfinished_;
  FileLock lock_;  ///< of active_path_, while it is to be removed
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace fast_edi
