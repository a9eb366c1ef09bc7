#include "recording/mcap_storage.hpp"

#include <algorithm>
#include <cstring>

#include "fast_edi/recording/recording_error.hpp"
#include "recording/mcap_records.hpp"
#include "recording/number_at.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kMagicBytes = sizeof(McapStorage::kMagic) - 1;

}  // namespace

McapStorage::McapStorage(const ByteSource& file, const std::string& name)
    : file_(file), chunk_reader_(file) {
  const std::uint8_t* begin = file_.read(0, kMagicBytes, scratch_);
  if (begin == nullptr || std::memcmp(begin, kMagic, kMagicBytes) != 0) {
    throw RecordingError(name + ", byte 0: expected the first bytes of MCAP");
  }
  index_ = readMcapIndex(file_, kMagicBytes, chunk_reader_, topics_);
  for (const RecordingDamage& damage : index_.damage) {
    note(damage.offset, damage.what);
  }
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

void McapStorage::addWaiting(const Waiting& waiting) {
  waiting_.push_back(waiting);
  std::push_heap(waiting_.begin(), waiting_.end());
}

void McapStorage::openChunk(std::size_t part) {
  const McapRecord& in_file = index_.parts[part].record;
  Chunk& chunk = chunks_[part];
  const std::string fault = chunk_reader_.read(in_file, chunk.records);
  if (!fault.empty()) {
    note(in_file.content, fault);
  }
  const RawBytes& records = chunk.records;
  std::size_t place = 0;
  while (const std::optional<McapRecord> record = mcapRecordAt(records, place)) {
    const auto start = static_cast<std::size_t>(record->content);
    const auto size = static_cast<std::size_t>(record->size);
    const std::uint8_t* content = records.data() + start;
    if (record->kind != kMcapMessage) {
      topics_.add(record->kind, content, size);
    } else if (size >= kMcapMessageHeaderBytes) {
      addWaiting({numberAt<std::uint64_t>(content + kMcapMessageTime), part, start, size});
      ++chunk.left;
    }
    place = static_cast<std::size_t>(record->end());
  }
  if (place != records.size()) {
    note(in_file.content, "a record at byte " + std::to_string(place) +
                              " of a chunk ends behind its " + mcapSizeText(records.size()));
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
  const McapPart& part = index_.parts[waiting.part];
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
  const std::optional<std::size_t> topic = topics_.find(channel);
  if (content == nullptr || !topic) {
    note(part.record.content,
         content == nullptr
             ? "cannot be read"
             : "a message of channel " + std::to_string(channel) + ", which there is none of");
    return false;
  }
  message.topic = *topic;
  message.record_ns = static_cast<std::int64_t>(waiting.time_ns);
  message.offset = part.record.content;
  message.data = content + kMcapMessageHeaderBytes;
  message.size = waiting.size - kMcapMessageHeaderBytes;
  return true;
}

void McapStorage::openParts() {
  const std::vector<McapPart>& parts = index_.parts;
  while (opened_ < parts.size() &&
         (waiting_.empty() ||
          (parts[opened_].begin_ns <= waiting_.front().time_ns && open_bytes_ < kMaxOpenBytes))) {
    const std::size_t number = opened_++;
    const McapPart& part = parts[number];
    if (part.is_chunk) {
      openChunk(number);
    } else {
      addWaiting({part.begin_ns, number, 0, static_cast<std::size_t>(part.record.size)});
    }
  }
}

bool McapStorage::next(Rosbag2Message& message) {
  for (;;) {
    release();
    openParts();
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
  if (!ended_ && index_.expected_messages.value_or(messages_) != messages_) {
    note(file_.size(), std::to_string(messages_) + " messages are found, expected " +
                           std::to_string(*index_.expected_messages));
  }
  ended_ = true;
  return false;
}

std::string McapStorage::format() const {
  const std::optional<Compression> compression = mcapCompression(index_.compression);
  return "MCAP, " + (compression ? std::string(toString(*compression)) : index_.compression);
}

double McapStorage::progress() const {
  const std::vector<McapPart>& parts = index_.parts;
  return parts.empty() ? 1.0 : static_cast<double>(opened_) / static_cast<double>(parts.size());
}

}  // namespace fast_edi
