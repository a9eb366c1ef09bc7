/// \file
/// Which files a rosbag2 consists of.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"
#include "recording/rosbag2_storage.hpp"

namespace fast_edi {

/// What a rosbag2's metadata.yaml or its folder contains.
struct Rosbag2Files {
  std::vector<std::string> paths;    ///< in the order of time
  std::vector<Rosbag2Topic> topics;  ///< as far as metadata.yaml has them
  std::optional<std::uint64_t> messages;
  std::vector<std::string> faults;
};

/// Whether a folder holds files that rosbag2 writes.
bool isRosbag2Folder(const std::string& path);

/// \param path of the folder, of its metadata.yaml, or of one file with messages
/// \throws RecordingError when there are none
Rosbag2Files findRosbag2Files(const std::string& path);

/// One file of messages with all that it needs.
class Rosbag2File {
 public:
  /// SQLite or MCAP by its first bytes, perhaps compressed as a whole.
  /// \throws RecordingError when nothing at all can be read
  explicit Rosbag2File(const std::string& path);

  Rosbag2Storage& storage() const { return *storage_; }
  const std::string& path() const { return path_; }
  /// Compressed or not [bytes].
  std::uint64_t size() const { return file_.size(); }
  bool isCompressed() const { return decompressed_ != nullptr; }
  /// Of the compression of the whole file; empty if there is none.
  const std::string& fault() const { return fault_; }

 private:
  std::string path_;
  FileSource file_;
  std::unique_ptr<ByteSource> decompressed_;
  std::unique_ptr<FileSource> log_;
  std::string fault_;
  std::unique_ptr<Rosbag2Storage> storage_;
};

}  // namespace fast_edi
