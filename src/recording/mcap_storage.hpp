/// \file
/// MCAP files (https://mcap.dev/spec), which rosbag2 writes by default since ROS 2 Iron.
///
/// Read by our own code: no package of Debian has a library. A first pass over the records, which
/// leaves out what is in the chunks, finds where they lie and which times they have
/// (mcap_index.hpp); then chunks are opened as their times come, so that messages come in the order
/// of their record times. A chunk that overlaps no other is alone in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "fast_edi/base/raw_bytes.hpp"
#include "recording/mcap_chunk_reader.hpp"
#include "recording/mcap_index.hpp"
#include "recording/mcap_topics.hpp"
#include "recording/rosbag2_storage.hpp"

namespace fast_edi {

class McapStorage : public Rosbag2Storage {
 public:
  static constexpr char kMagic[] = "\x89MCAP0\r\n";
  /// Chunks that are open at the same time are no larger together [bytes, decompressed].
  static constexpr std::size_t kMaxOpenBytes = std::size_t{256} << 20;

  /// \param file must outlive this
  /// \param name of the file, for messages
  /// \throws RecordingError when the file does not begin as it must
  McapStorage(const ByteSource& file, const std::string& name);

  std::string format() const override;
  const std::vector<Rosbag2Topic>& topics() const override { return topics_.topics(); }
  bool next(Rosbag2Message& message) override;
  double progress() const override;

 protected:
  void restart() override;

 private:
  struct Chunk {
    RawBytes records;
    std::size_t left = 0;  ///< messages that were not given yet
  };
  /// A message that can be given.
  struct Waiting {
    std::uint64_t time_ns = 0;
    std::size_t part = 0;   ///< index into the index's parts
    std::size_t place = 0;  ///< of its content in the chunk's records; 0 outside of chunks
    std::size_t size = 0;   ///< of its content

    /// A heap has the least of these in front: the earliest message.
    friend bool operator<(const Waiting& a, const Waiting& b) {
      return std::tie(b.time_ns, b.part, b.place) < std::tie(a.time_ns, a.part, a.place);
    }
  };

  /// Opens parts until the earliest message that is waiting is the next one.
  void openParts();
  void openChunk(std::size_t part);
  void addWaiting(const Waiting& waiting);
  bool give(const Waiting& waiting, Rosbag2Message& message);
  void release();

  const ByteSource& file_;
  McapChunkReader chunk_reader_;
  McapTopics topics_;
  McapIndex index_;
  std::vector<std::uint8_t> scratch_;
  std::size_t opened_ = 0;               ///< parts
  std::map<std::size_t, Chunk> chunks_;  ///< that are open, by their part
  std::size_t open_bytes_ = 0;
  std::vector<Waiting> waiting_;           ///< a heap
  std::optional<std::size_t> given_part_;  ///< the part of the message that was given last
  std::uint64_t messages_ = 0;             ///< given, or noted as damaged
  bool ended_ = false;
};

}  // namespace fast_edi
