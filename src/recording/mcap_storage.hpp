/// \file
/// MCAP files (https://mcap.dev/spec), which rosbag2 writes by default since ROS 2 Iron.
///
/// Read by our own code: no package of Debian has a library. A first pass over the records, which
/// leaves out what is in the chunks, finds where they lie and which times they have; then chunks
/// are opened as their times come, so that messages come in the order of their record times. A
/// chunk that overlaps no other is alone in memory.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "recording/packet_compression.hpp"
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
  const std::vector<Rosbag2Topic>& topics() const override { return topics_; }
  bool next(Rosbag2Message& message) override;
  double progress() const override;

 protected:
  void restart() override;

 private:
  struct Record {
    std::uint8_t kind = 0;
    std::uint64_t content = 0;  ///< its offset in the file
    std::uint64_t size = 0;     ///< of the content
    std::uint64_t end() const { return content + size; }
  };
  struct Chunk {
    std::vector<std::uint8_t> records;
    std::size_t left = 0;  ///< messages that were not given yet
  };
  /// A chunk, or a message outside of chunks.
  struct Part {
    std::uint64_t begin_ns = 0;
    Record record;
    bool is_chunk = false;
  };
  /// A message that can be given.
  struct Waiting {
    std::uint64_t time_ns = 0;
    std::size_t part = 0;   ///< index into parts_
    std::size_t place = 0;  ///< of its content in the chunk's records; 0 outside of chunks
    std::size_t size = 0;   ///< of its content

    /// A heap has the least of these in front: the earliest message.
    friend bool operator<(const Waiting& a, const Waiting& b) {
      return std::tie(b.time_ns, b.part, b.place) < std::tie(a.time_ns, a.part, a.place);
    }
  };

  /// What the records in the file say about the whole of it.
  struct Overview {
    bool complete = false;  ///< there is an end
    std::uint64_t chunks = 0;
    std::optional<std::uint64_t> expected_chunks;
  };

  /// \return nothing where no record can be
  std::optional<Record> recordAt(std::uint64_t offset);
  void findParts();
  void addPart(const Record& record, Overview& overview);
  /// Schemas, channels, numbers of all that is there.
  void takeRecord(const Record& record, Overview& overview);
  /// Where reading goes on behind damage: the next chunk, or the end of the file.
  std::uint64_t findChunk(std::uint64_t from);
  void addSchema(const std::uint8_t* content, std::size_t size);
  void addChannel(const std::uint8_t* content, std::size_t size);
  /// Topics that only the chunks contain: those of an interrupted recording.
  void findTopicsInChunks();
  /// \return what is wrong; empty if nothing is
  std::string loadChunk(const Record& record, std::vector<std::uint8_t>& records);
  void openChunk(std::size_t part);
  bool give(const Waiting& waiting, Rosbag2Message& message);
  void release();

  const ByteSource& file_;
  Decompressor decompressor_;
  std::vector<std::uint8_t> scratch_;
  std::map<std::uint16_t, std::string> schemas_;  ///< names
  std::map<std::uint16_t, std::size_t> numbers_;  ///< from channels to topics_
  std::vector<Rosbag2Topic> topics_;
  std::string compression_;              ///< of the first chunk
  std::vector<Part> parts_;              ///< in the order of their times
  std::size_t opened_ = 0;               ///< parts
  std::map<std::size_t, Chunk> chunks_;  ///< that are open, by their part
  std::size_t open_bytes_ = 0;
  std::vector<Waiting> waiting_;           ///< a heap
  std::optional<std::size_t> given_part_;  ///< the part of the message that was given last
  std::uint64_t messages_ = 0;             ///< given, or noted as damaged
  std::optional<std::uint64_t> expected_messages_;
  bool ended_ = false;
};

}  // namespace fast_edi
