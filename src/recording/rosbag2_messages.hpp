/// \file
/// The messages of a rosbag2, file after file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/base/raw_bytes.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/packet_compression.hpp"
#include "recording/rosbag2_files.hpp"
#include "recording/rosbag2_storage.hpp"

namespace fast_edi {

class Rosbag2Messages {
 public:
  /// \param path see findRosbag2Files()
  /// \throws RecordingError when no file can be read
  explicit Rosbag2Messages(const std::string& path);

  /// For people, e.g. "rosbag2, MCAP".
  const std::string& format() const { return format_; }
  /// By metadata.yaml and the first file; without metadata by all of them.
  const std::vector<Rosbag2Topic>& topics() const { return topics_; }
  /// Of all files [bytes].
  std::uint64_t fileSize() const { return file_size_; }
  /// How far next() has come, and what that is at the end.
  std::uint64_t position() const;
  std::uint64_t length() const;

  /// \return false at the end
  bool next(Rosbag2Message& message);
  /// The next message of the first file, to look at before the first call of next().
  bool peek(Rosbag2Message& message);
  /// As if nothing had been peeked at, notes included.
  void rewind();
  /// Decompresses a message that was compressed by itself; it is valid until the next call.
  /// \return false when nothing can be read
  bool uncompress(Rosbag2Message& message);

  // Of a message until the next one:
  const Rosbag2Topic& topicOf(const Rosbag2Message& message) const {
    return file_->storage().topics()[message.topic];
  }
  /// Index of its file.
  std::size_t file() const { return file_index_; }
  void note(const Rosbag2Message& message, const std::string& what);

  const std::vector<RecordingDamage>& damage() const { return damage_; }

 private:
  void readHeads();
  bool openFile();
  void copyNotes();
  std::string fileName() const;

  const Rosbag2Files files_;
  std::string format_;
  std::vector<Rosbag2Topic> topics_;
  std::uint64_t file_size_ = 0;
  std::vector<RecordingDamage> damage_;
  std::size_t first_notes_ = 0;  ///< of the construction
  Decompressor decompressor_;
  RawBytes uncompressed_;

  std::size_t file_index_ = 0;
  std::unique_ptr<Rosbag2File> file_;
  std::size_t copied_notes_ = 0;  ///< of the file
  std::uint64_t count_ = 0;
  bool noted_missing_ = false;
};

}  // namespace fast_edi
