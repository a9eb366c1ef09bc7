#include "recording/mcap_storage.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include <boost/crc.hpp>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kMagicBytes = sizeof(McapStorage::kMagic) - 1;
/// Kind (1 byte) and size (8 bytes) of a record.
constexpr std::size_t kRecordHeaderBytes = 9;

// Kinds of records.
constexpr std::uint8_t kHeader = 0x01;
constexpr std::uint8_t kFooter = 0x02;
constexpr std::uint8_t kSchema = 0x03;
constexpr std::uint8_t kChannel = 0x04;
constexpr std::uint8_t kMessage = 0x05;
constexpr std::uint8_t kChunk = 0x06;
constexpr std::uint8_t kStatistics = 0x0B;
constexpr std::uint8_t kDataEnd = 0x0F;
/// Those from here on are of programs' own.
constexpr std::uint8_t kFirstPrivate = 0x80;

/// Channel, sequence, time of record, time of sending.
constexpr std::size_t kMessageHeaderBytes = 22;
constexpr std::size_t kMessageTime = 6;
/// Two times, size, checksum, length of the compression's name, size of the records.
constexpr std::size_t kChunkHeaderBytes = 40;
constexpr std::size_t kMaxCompressionName = 16;
/// Schemas and channels are no larger.
constexpr std::size_t kMaxDescriptionBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxTopics = 65'536;
/// How far a search for the next chunk reads at once.
constexpr std::size_t kSearchBlockBytes = std::size_t{1} << 20;

/// Little-endian numbers and strings, one after the other. After the first that lies beyond the
/// end, ok() is false and all that is read is 0 or empty.
class Fields {
 public:
  Fields(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool ok() const { return ok_; }
  std::size_t place() const { return place_; }

  template <typename Number>
  Number number() {
    Number value{};
    if (!ok_ || size_ - place_ < sizeof(value)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, data_ + place_, sizeof(value));
    place_ += sizeof(value);
    return value;
  }
  std::string text() {
    const auto count = number<std::uint32_t>();
    if (!ok_ || count > size_ - place_) {
      ok_ = false;
      return {};
    }
    place_ += count;
    return {reinterpret_cast<const char*>(data_ + place_ - count), count};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t place_ = 0;
  bool ok_ = true;
};

/// What stands in a chunk before its records.
struct ChunkHeader {
  std::uint64_t begin_ns = 0;
  std::uint64_t records_bytes = 0;  ///< as stated
  std::uint32_t checksum = 0;       ///< 0: none
  std::string compression;
  std::size_t header_bytes = 0;
};

/// Nothing when it contradicts the size of the chunk.
std::optional<ChunkHeader> chunkHeader(const std::uint8_t* data, std::size_t there,
                                       std::uint64_t chunk_bytes) {
  Fields fields(data, there);
  ChunkHeader header;
  header.begin_ns = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // its end
  header.records_bytes = fields.number<std::uint64_t>();
  header.checksum = fields.number<std::uint32_t>();
  header.compression = fields.text();
  const auto stored = fields.number<std::uint64_t>();
  header.header_bytes = fields.place();
  if (!fields.ok() || header.compression.size() > kMaxCompressionName ||
      chunk_bytes < header.header_bytes || stored != chunk_bytes - header.header_bytes) {
    return std::nullopt;
  }
  return header;
}

std::optional<Compression> compressionOf(const std::string& name) {
  if (name.empty()) {
    return Compression::kNone;
  }
  if (name == "lz4") {
    return Compression::kLz4;
  }
  return name == "zstd" ? std::optional(Compression::kZstd) : std::nullopt;
}

std::string sizeText(std::uint64_t size) {
  return std::to_string(size) + " bytes";
}

}  // namespace

McapStorage::McapStorage(const ByteSource& file, const std::string& name) : file_(file) {
  const std::uint8_t* begin = file_.read(0, kMagicBytes, scratch_);
  if (begin == nullptr || std::memcmp(begin, kMagic, kMagicBytes) != 0) {
    throw RecordingError(name + ", byte 0: expected the first bytes of MCAP");
  }
  findParts();
  keepNotes();
}

void McapStorage::restart() {
  opened_ = 0;
  chunks_.clear();
  open_bytes_ = 0;
  waiting_.clear();
  given_part_.reset();
  messages_ = 0;
  ended_ = false;
}

std::optional<McapStorage::Record> McapStorage::recordAt(std::uint64_t offset) {
  const std::uint8_t* bytes = file_.read(offset, kRecordHeaderBytes, scratch_);
  if (bytes == nullptr) {
    return std::nullopt;
  }
  Record record;
  record.kind = bytes[0];
  std::memcpy(&record.size, bytes + 1, sizeof(record.size));
  record.content = offset + kRecordHeaderBytes;
  const bool known =
      (record.kind >= kHeader && record.kind <= kDataEnd) || record.kind >= kFirstPrivate;
  return known && record.size <= file_.size() - record.content ? std::optional(record)
                                                               : std::nullopt;
}

void McapStorage::findParts() {
  Overview overview;
  std::uint64_t offset = kMagicBytes;
  while (offset < file_.size() && !overview.complete) {
    const std::optional<Record> record = recordAt(offset);
    if (!record) {
      note(offset, "expected a record of MCAP that ends within the file, " +
                       sizeText(file_.size() - offset) + " are left");
      offset = findChunk(offset + 1);
      continue;
    }
    takeRecord(*record, overview);
    offset = record->end();
  }
  if (!overview.complete) {
    note(file_.size(), "expected a footer: the file is cut, or its recorder was interrupted");
    findTopicsInChunks();
  } else if (overview.expected_chunks.value_or(overview.chunks) != overview.chunks) {
    note(file_.size(), std::to_string(overview.chunks) + " chunks are found, expected " +
                           std::to_string(*overview.expected_chunks));
  }
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const Part& a, const Part& b) { return a.begin_ns < b.begin_ns; });
}

void McapStorage::takeRecord(const Record& record, Overview& overview) {
  switch (record.kind) {
    case kFooter:
      overview.complete = true;
      return;
    case kMessage:
    case kChunk:
      addPart(record, overview);
      return;
    case kSchema:
    case kChannel:
    case kStatistics:
      break;
    default:
      return;
  }
  const std::uint8_t* content =
      record.size <= kMaxDescriptionBytes
          ? file_.read(record.content, static_cast<std::size_t>(record.size), scratch_)
          : nullptr;
  if (content == nullptr) {
    note(record.content, "a description of " + sizeText(record.size) + ": left out");
    return;
  }
  const auto size = static_cast<std::size_t>(record.size);
  if (record.kind == kSchema) {
    addSchema(content, size);
  } else if (record.kind == kChannel) {
    addChannel(content, size);
  } else {
    Fields fields(content, size);
    const auto messages = fields.number<std::uint64_t>();
    fields.number<std::uint16_t>();  // schemas
    fields.number<std::uint32_t>();  // channels
    fields.number<std::uint32_t>();  // attachments
    fields.number<std::uint32_t>();  // metadata
    const auto chunks = fields.number<std::uint32_t>();
    if (fields.ok()) {
      expected_messages_ = messages;
      overview.expected_chunks = chunks;
    }
  }
}

void McapStorage::addPart(const Record& record, Overview& overview) {
  Part part;
  part.record = record;
  part.is_chunk = record.kind == kChunk;
  const auto there = static_cast<std::size_t>(
      std::min<std::uint64_t>(record.size, kChunkHeaderBytes + kMaxCompressionName));
  const std::uint8_t* bytes = file_.read(record.content, there, scratch_);
  if (bytes == nullptr || record.size > kMaxMessageBytes) {
    note(record.content, "a message or chunk of " + sizeText(record.size) + ", expected at most " +
                             sizeText(kMaxMessageBytes) + ": left out");
    return;
  }
  if (part.is_chunk) {
    const std::optional<ChunkHeader> header = chunkHeader(bytes, there, record.size);
    if (!header) {
      note(record.content, "the header of a chunk of " + sizeText(record.size) + " is damaged");
      return;
    }
    if (overview.chunks == 0) {
      compression_ = header->compression;
    }
    ++overview.chunks;
    part.begin_ns = header->begin_ns;
  } else {
    if (there < kMessageHeaderBytes) {
      note(record.content, "a message of " + sizeText(record.size) + ", expected at least " +
                               sizeText(kMessageHeaderBytes));
      return;
    }
    std::memcpy(&part.begin_ns, bytes + kMessageTime, sizeof(part.begin_ns));
  }
  parts_.push_back(part);
}

std::uint64_t McapStorage::findChunk(std::uint64_t from) {
  constexpr std::size_t kNeeded = kRecordHeaderBytes + kChunkHeaderBytes;
  std::vector<std::uint8_t> block;
  while (from < file_.size() && file_.size() - from >= kNeeded) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(kSearchBlockBytes, file_.size() - from));
    const std::uint8_t* bytes = file_.read(from, count, block);
    if (bytes == nullptr) {
      break;
    }
    for (std::size_t i = 0; i + kNeeded <= count; ++i) {
      if (bytes[i] != kChunk) {
        continue;
      }
      std::uint64_t size = 0;
      std::memcpy(&size, bytes + i + 1, sizeof(size));
      if (size <= file_.size() - from - i - kRecordHeaderBytes &&
          chunkHeader(bytes + i + kRecordHeaderBytes, count - i - kRecordHeaderBytes, size)) {
        return from + i;
      }
    }
    from += count - kNeeded + 1;
  }
  return file_.size();
}

void McapStorage::addSchema(const std::uint8_t* content, std::size_t size) {
  Fields fields(content, size);
  const auto id = fields.number<std::uint16_t>();
  std::string name = fields.text();
  if (fields.ok()) {
    schemas_[id] = std::move(name);
  }
}

void McapStorage::addChannel(const std::uint8_t* content, std::size_t size) {
  Fields fields(content, size);
  const auto id = fields.number<std::uint16_t>();
  const auto schema = fields.number<std::uint16_t>();
  Rosbag2Topic topic;
  topic.name = fields.text();
  topic.format = fields.text();
  if (!fields.ok() || numbers_.count(id) > 0 || topics_.size() >= kMaxTopics) {
    return;
  }
  topic.type = schemas_[schema];
  numbers_[id] = topics_.size();
  topics_.push_back(std::move(topic));
}

void McapStorage::findTopicsInChunks() {
  std::vector<std::uint8_t> records;
  for (const Part& part : parts_) {
    if (!part.is_chunk) {
      continue;
    }
    loadChunk(part.record, records);  // what is damaged is noted when it is read
    for (std::size_t place = 0; records.size() - place >= kRecordHeaderBytes;) {
      std::uint64_t size = 0;
      std::memcpy(&size, records.data() + place + 1, sizeof(size));
      const std::size_t content = place + kRecordHeaderBytes;
      if (size > records.size() - content) {
        break;
      }
      if (records[place] == kSchema) {
        addSchema(records.data() + content, static_cast<std::size_t>(size));
      } else if (records[place] == kChannel) {
        addChannel(records.data() + content, static_cast<std::size_t>(size));
      }
      place = content + static_cast<std::size_t>(size);
    }
  }
}

std::string McapStorage::loadChunk(const Record& record, std::vector<std::uint8_t>& records) {
  records.clear();
  const auto size = static_cast<std::size_t>(record.size);
  const std::uint8_t* bytes = file_.read(record.content, size, scratch_);
  if (bytes == nullptr) {
    return "cannot be read";
  }
  const std::optional<ChunkHeader> header = chunkHeader(bytes, size, record.size);
  if (!header) {
    return "the header of a chunk is damaged";
  }
  const std::optional<Compression> compression = compressionOf(header->compression);
  if (!compression) {
    return "a chunk with the compression \"" + header->compression +
           "\", expected none, lz4 or zstd";
  }
  std::string fault = decompressor_.run(*compression, bytes + header->header_bytes,
                                        size - header->header_bytes, kMaxMessageBytes, records);
  if (!fault.empty()) {
    return fault;
  }
  if (records.size() != header->records_bytes) {
    return "a chunk of " + sizeText(records.size()) + ", expected " +
           sizeText(header->records_bytes);
  }
  if (header->checksum != 0) {
    boost::crc_32_type checksum;
    checksum.process_bytes(records.data(), records.size());
    if (checksum.checksum() != header->checksum) {
      return "the checksum of a chunk does not fit: what is in it may be wrong";
    }
  }
  return {};
}

void McapStorage::openChunk(std::size_t part) {
  const Record& record = parts_[part].record;
  Chunk& chunk = chunks_[part];
  const std::string fault = loadChunk(record, chunk.records);
  if (!fault.empty()) {
    note(record.content, fault);
  }
  const std::vector<std::uint8_t>& records = chunk.records;
  std::size_t place = 0;
  while (records.size() - place >= kRecordHeaderBytes) {
    const std::uint8_t kind = records[place];
    std::uint64_t stated = 0;
    std::memcpy(&stated, records.data() + place + 1, sizeof(stated));
    const std::size_t content = place + kRecordHeaderBytes;
    if (stated > records.size() - content) {
      break;
    }
    const auto size = static_cast<std::size_t>(stated);
    if (kind == kSchema) {
      addSchema(records.data() + content, size);
    } else if (kind == kChannel) {
      addChannel(records.data() + content, size);
    } else if (kind == kMessage && size >= kMessageHeaderBytes) {
      Waiting waiting{0, part, content, size};
      std::memcpy(&waiting.time_ns, records.data() + content + kMessageTime,
                  sizeof(waiting.time_ns));
      waiting_.push_back(waiting);
      std::push_heap(waiting_.begin(), waiting_.end());
      ++chunk.left;
    }
    place = content + size;
  }
  if (place != records.size()) {
    note(record.content, "a record at byte " + std::to_string(place) +
                             " of a chunk ends behind its " + sizeText(records.size()));
  }
  open_bytes_ += records.size();
  if (chunk.left == 0) {
    given_part_ = part;
    release();
  }
}

void McapStorage::release() {
  if (!given_part_) {
    return;
  }
  const auto chunk = chunks_.find(*given_part_);
  if (chunk != chunks_.end() && chunk->second.left == 0) {
    open_bytes_ -= chunk->second.records.size();
    chunks_.erase(chunk);
  }
  given_part_.reset();
}

bool McapStorage::give(const Waiting& waiting, Rosbag2Message& message) {
  const Part& part = parts_[waiting.part];
  const std::uint8_t* content = nullptr;
  if (part.is_chunk) {
    Chunk& chunk = chunks_.at(waiting.part);
    content = chunk.records.data() + waiting.place;
    --chunk.left;
  } else {
    content = file_.read(part.record.content, waiting.size, scratch_);
  }
  given_part_ = waiting.part;
  ++messages_;
  std::uint16_t channel = 0;
  if (content != nullptr) {
    std::memcpy(&channel, content, sizeof(channel));
  }
  const auto number = numbers_.find(channel);
  if (content == nullptr || number == numbers_.end()) {
    note(part.record.content,
         content == nullptr
             ? "cannot be read"
             : "a message of channel " + std::to_string(channel) + ", which there is none of");
    return false;
  }
  message.topic = number->second;
  message.record_ns = static_cast<std::int64_t>(waiting.time_ns);
  message.offset = part.record.content;
  message.data = content + kMessageHeaderBytes;
  message.size = waiting.size - kMessageHeaderBytes;
  return true;
}

bool McapStorage::next(Rosbag2Message& message) {
  for (;;) {
    release();
    while (opened_ < parts_.size() &&
           (waiting_.empty() || (parts_[opened_].begin_ns <= waiting_.front().time_ns &&
                                 open_bytes_ < kMaxOpenBytes))) {
      const std::size_t part = opened_++;
      if (parts_[part].is_chunk) {
        openChunk(part);
      } else {
        waiting_.push_back(
            {parts_[part].begin_ns, part, 0, static_cast<std::size_t>(parts_[part].record.size)});
        std::push_heap(waiting_.begin(), waiting_.end());
      }
    }
    if (waiting_.empty()) {
      break;
    }
    std::pop_heap(waiting_.begin(), waiting_.end());
    const Waiting waiting = waiting_.back();
    waiting_.pop_back();
    if (give(waiting, message)) {
      return true;
    }
  }
  if (!ended_ && expected_messages_.value_or(messages_) != messages_) {
    note(file_.size(), std::to_string(messages_) + " messages are found, expected " +
                           std::to_string(*expected_messages_));
  }
  ended_ = true;
  return false;
}

std::string McapStorage::format() const {
  const std::optional<Compression> compression = compressionOf(compression_);
  return "MCAP, " + (compression ? std::string(toString(*compression)) : compression_);
}

double McapStorage::progress() const {
  return parts_.empty() ? 1.0 : static_cast<double>(opened_) / static_cast<double>(parts_.size());
}

}  // namespace fast_edi
