#include "fast_edi/bags/bag_index.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

#include <boost/make_shared.hpp>

#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {
namespace {

constexpr std::string_view kVersionPrefix = "#ROSBAG V";
constexpr std::string_view kVersionLine = "#ROSBAG V2.0\n";
constexpr std::size_t kIndexEntryBytes = 12;  ///< time: 2 x u32, offset in the chunk: u32
constexpr std::string_view kUnencrypted = "rosbag/NoEncryptor";

std::uint64_t timeKey(std::uint64_t wire_time) {
  // On the wire the seconds come first, so they are the low half.
  return (wire_time << 32) | (wire_time >> 32);
}

std::string_view dataOf(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

/// Walks a file and collects what it finds.
class IndexBuilder {
 public:
  IndexBuilder(const ByteSource& file, const std::string& path) : file_(file), path_(path) {}

  BagIndex build() {
    readVersion();
    walk();
    findMissingConnections();
    checkEnd();
    countMessages();
    const auto earlier = [](const BagIndexEntry& a, const BagIndexEntry& b) {
      return a.time < b.time;
    };
    if (!std::is_sorted(index_.entries.begin(), index_.entries.end(), earlier)) {
      std::stable_sort(index_.entries.begin(), index_.entries.end(), earlier);
    }
    for (const BagIndexEntry& entry : index_.entries) {
      index_.chunks[entry.chunk].last_time = entry.time;
    }
    return std::move(index_);
  }

 private:
  /// The chunk that was read last, and its index so far.
  struct LastChunk {
    bool open = false;        ///< its index records may still follow
    bool index_whole = true;  ///< no damage since its data
    bool cut = false;         ///< it ends early, and that was noted
    std::vector<BagIndexEntry> entries;
    std::vector<std::uint32_t> connections;  ///< of the entries
  };

  void readVersion() {
    const std::size_t count = std::min<std::uint64_t>(file_.size(), kVersionLine.size());
    const std::uint8_t* bytes = file_.read(0, count, scratch_);
    const std::string_view line = bytes == nullptr ? std::string_view() : dataOf(bytes, count);
    if (line == kVersionLine) {
      return;
    }
    if (line.substr(0, kVersionPrefix.size()) == kVersionPrefix) {
      throw BagError(path_ + " is a bag of another version: expected 2.0 (see `rosbag migrate`)");
    }
    throw BagError(path_ + " is no bag: it does not begin with \"#ROSBAG V2.0\"");
  }

  void walk() {
    std::uint64_t position = kVersionLine.size();
    while (position < file_.size()) {
      const std::optional<Record> record = readRecord(file_, position, scratch_);
      const bool usable = record && (record->complete(file_) || record->kind == RecordKind::kChunk);
      if (!usable) {
        const bool cut = record.has_value();
        noteDamage(position, cut ? "a record is cut off" : "no record where one is expected");
        last_chunk_.index_whole = false;
        const std::optional<std::uint64_t> next = findChunkRecord(file_, position + 1);
        if (!next) {
          break;
        }
        position = *next;
        continue;
      }
      position = take(*record, position);
    }
    endChunk();
  }

  /// \return where the next record starts
  std::uint64_t take(const Record& record, std::uint64_t position) {
    switch (record.kind) {
      case RecordKind::kFileHeader:
        readFileHeader(record.header);
        break;
      case RecordKind::kChunk:
        return takeChunk(record, position);
      case RecordKind::kIndex:
        takeIndex(record);
        break;
      case RecordKind::kConnection:
        endChunk();
        ++connection_records_;
        addConnection(file_, record);
        break;
      case RecordKind::kChunkInfo:
        endChunk();
        ++chunk_info_records_;
        break;
      case RecordKind::kMessage:
        noteDamage(position, "a message outside of any chunk");
        break;
    }
    return record.end();
  }

  void readFileHeader(const RecordHeader& header) {
    const std::optional<std::string_view> encryptor = header.text("encryptor");
    if (encryptor && !encryptor->empty() && *encryptor != kUnencrypted) {
      throw BagError(path_ + " is encrypted (" + std::string(*encryptor) + ")");
    }
    index_position_ = header.number<std::uint64_t>("index_pos").value_or(0);
    stated_connections_ = header.number<std::uint32_t>("conn_count").value_or(0);
    stated_chunks_ = header.number<std::uint32_t>("chunk_count").value_or(0);
  }

  std::uint64_t takeChunk(const Record& record, std::uint64_t position) {
    endChunk();
    const std::string compression(record.header.text("compression").value_or(""));
    if (!isKnownCompression(compression)) {
      noteDamage(position, "a chunk of unknown compression \"" + compression + "\"");
      return std::min(record.end(), file_.size());
    }
    BagChunk chunk;
    chunk.compression = compression;
    chunk.offset = record.data_offset;
    chunk.size = record.data_size;
    chunk.full_size = record.header.number<std::uint32_t>("size").value_or(0);
    std::uint64_t next = record.end();
    if (record.data_size == 0 || !record.complete(file_)) {
      // rosbag fills the lengths in when it has written the chunk: zero if it was killed before.
      // A length beyond the file is a cut, or damage with other chunks behind it.
      next = findChunkRecord(file_, record.data_offset).value_or(file_.size());
      noteDamage(next, record.data_size == 0 ? "a chunk was never finished" : "a chunk is cut off");
      chunk.size = next - record.data_offset;
      chunk.cut = true;
      last_chunk_.cut = true;
      last_chunk_.index_whole = false;
    }
    index_.chunks.push_back(std::move(chunk));
    last_chunk_.open = true;
    return next;
  }

  void takeIndex(const Record& record) {
    const std::uint8_t* data = file_.read(record.data_offset, record.data_size, data_scratch_);
    const std::uint32_t count = record.header.number<std::uint32_t>("count").value_or(0);
    if (!last_chunk_.open || data == nullptr ||
        record.data_size != std::uint64_t{count} * kIndexEntryBytes) {
      noteDamage(record.data_offset, "an index record of wrong size");
      last_chunk_.index_whole = false;
      return;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint64_t time = 0;
      std::uint32_t offset = 0;
      std::memcpy(&time, data + i * kIndexEntryBytes, sizeof(time));
      std::memcpy(&offset, data + i * kIndexEntryBytes + sizeof(time), sizeof(offset));
      last_chunk_.entries.push_back({timeKey(time), offset, currentChunk()});
      last_chunk_.connections.push_back(record.header.number<std::uint32_t>("conn").value_or(0));
    }
  }

  std::uint32_t currentChunk() const {
    return static_cast<std::uint32_t>(index_.chunks.size() - 1);
  }

  /// The records that belong to the open chunk are over.
  void endChunk() {
    if (!last_chunk_.open) {
      return;
    }
    last_chunk_.open = false;
    if (last_chunk_.index_whole && !last_chunk_.entries.empty()) {
      takeChunkIndex();
    } else {
      scanChunk(currentChunk(), true);
    }
    last_chunk_.entries.clear();
    last_chunk_.connections.clear();
    last_chunk_.index_whole = true;
    last_chunk_.cut = false;
  }

  void takeChunkIndex() {
    std::vector<std::size_t> order(last_chunk_.entries.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      order[i] = i;
    }
    // rosbag writes one index for each connection; the order in the file is that of the offsets.
    std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
      return last_chunk_.entries[a].offset < last_chunk_.entries[b].offset;
    });
    for (const std::size_t i : order) {
      index_.entries.push_back(last_chunk_.entries[i]);
      entry_connections_.push_back(last_chunk_.connections[i]);
    }
  }

  /// Goes through the records of a chunk for connections and, if wanted, messages.
  void scanChunk(std::uint32_t number, bool take_messages) {
    const BagChunk& chunk = index_.chunks[number];
    if (!chunk.compressed()) {
      scanRecords(file_, chunk.offset, chunk.offset + chunk.size, number, take_messages);
      return;
    }
    const ChunkBytes bytes = readChunk(file_, chunk);
    if (!bytes.complete && !last_chunk_.cut) {
      noteDamage(chunk.offset, "a chunk cannot be decompressed to its end");
    }
    scanRecords(MemorySource(bytes.data.get(), bytes.size), 0, bytes.size, number, take_messages);
  }

  void scanRecords(const ByteSource& source, std::uint64_t begin, std::uint64_t end,
                   std::uint32_t chunk, bool take_messages) {
    std::vector<std::uint8_t> scratch;
    std::uint64_t position = begin;
    while (position < end) {
      const std::optional<Record> record = readRecord(source, position, scratch);
      if (!record || record->end() > end ||
          (record->kind != RecordKind::kMessage && record->kind != RecordKind::kConnection)) {
        if (!last_chunk_.cut) {
          noteDamage(index_.chunks[chunk].offset, "the records of a chunk break off");
        }
        return;
      }
      if (record->kind == RecordKind::kConnection) {
        addConnection(source, *record);
      } else if (take_messages) {
        const std::optional<std::uint64_t> time = record->header.number<std::uint64_t>("time");
        const std::optional<std::uint32_t> connection =
            record->header.number<std::uint32_t>("conn");
        if (time && connection) {
          index_.entries.push_back({timeKey(*time), position - begin, chunk});
          entry_connections_.push_back(*connection);
        }
      }
      position = record->end();
    }
  }

  void addConnection(const ByteSource& source, const Record& record) {
    const std::optional<std::uint32_t> id = record.header.number<std::uint32_t>("conn");
    const std::optional<std::string_view> topic = record.header.text("topic");
    if (!id || !topic || index_.connections.count(*id) > 0) {
      return;
    }
    BagConnection connection;
    connection.id = *id;
    connection.topic = *topic;
    const std::uint8_t* data = source.read(record.data_offset, record.data_size, data_scratch_);
    const std::optional<RecordHeader> fields =
        data == nullptr ? std::nullopt : RecordHeader::parse(dataOf(data, record.data_size));
    if (!fields) {
      noteDamage(record.data_offset, "the description of " + connection.topic + " is damaged");
      return;
    }
    connection.header = boost::make_shared<ros::M_string>();
    for (const auto& [name, value] : fields->fields()) {
      (*connection.header)[std::string(name)] = std::string(value);
    }
    connection.datatype = (*connection.header)["type"];
    connection.md5sum = (*connection.header)["md5sum"];
    connection.definition = (*connection.header)["message_definition"];
    index_.connections.emplace(*id, std::move(connection));
  }

  /// A file that is cut has lost the list of connections at its end, but each chunk holds those
  /// that are new in it.
  void findMissingConnections() {
    std::uint32_t last_scanned = 0;
    bool scanned = false;
    for (std::size_t i = 0; i < index_.entries.size(); ++i) {
      const std::uint32_t chunk = index_.entries[i].chunk;
      const bool known = index_.connections.count(entry_connections_[i]) > 0;
      if (!known && !(scanned && last_scanned == chunk)) {
        scanChunk(chunk, false);
        last_scanned = chunk;
        scanned = true;
      }
    }
  }

  void checkEnd() {
    if (index_position_ == 0) {
      noteDamage(file_.size(), "the bag was never closed: it has no index");
    } else if (index_position_ > file_.size()) {
      noteDamage(file_.size(), "the bag is cut short: its index should begin at byte " +
                                   std::to_string(index_position_));
    } else if (connection_records_ < stated_connections_ || chunk_info_records_ < stated_chunks_) {
      noteDamage(file_.size(), "the bag is cut short: its index is not complete");
    }
  }

  void countMessages() {
    for (const std::uint32_t id : entry_connections_) {
      const auto connection = index_.connections.find(id);
      if (connection != index_.connections.end()) {
        ++connection->second.messages;
      }
    }
  }

  void noteDamage(std::uint64_t offset, const std::string& what) {
    index_.damage.push_back({offset, what});
  }

  const ByteSource& file_;
  const std::string& path_;
  BagIndex index_;
  std::vector<std::uint32_t> entry_connections_;  ///< beside index_.entries until they are sorted
  LastChunk last_chunk_;

  std::uint64_t index_position_ = 0;
  std::uint32_t stated_connections_ = 0;
  std::uint32_t stated_chunks_ = 0;
  std::uint32_t connection_records_ = 0;
  std::uint32_t chunk_info_records_ = 0;

  std::vector<std::uint8_t> scratch_;
  std::vector<std::uint8_t> data_scratch_;
};

}  // namespace

BagIndex buildBagIndex(const ByteSource& file, const std::string& path) {
  return IndexBuilder(file, path).build();
}

ChunkBytes readChunk(const ByteSource& file, const BagChunk& chunk) {
  std::vector<std::uint8_t> scratch;
  const std::uint8_t* data = file.read(chunk.offset, chunk.size, scratch);
  if (data == nullptr) {
    return {};
  }
  return decompressChunk(chunk.compression, data, chunk.size, chunk.full_size);
}

}  // namespace fast_edi
