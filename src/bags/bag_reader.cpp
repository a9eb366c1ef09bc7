#include "fast_edi/bags/bag_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

namespace {

/// A record time as it may be used: damage leaves nanoseconds of more than a second, which roscpp
/// refuses here and carries there.
ros::Time soundTime(std::uint32_t sec, std::uint32_t nsec) {
  constexpr std::uint32_t kLastNanosecond = kNanosecondsPerSecond - 1;
  return {sec, std::min(nsec, kLastNanosecond)};
}

/// As BagIndexEntry has it.
std::uint64_t keyOf(const ros::Time& time) {
  return std::uint64_t{time.sec} << 32 | time.nsec;
}

}  // namespace

BagReader::BagReader(const std::string& path) : file_(path), index_(buildBagIndex(file_, path)) {}

bool BagReader::next(BagMessage& message) {
  while (position_ < index_.entries.size()) {
    const BagIndexEntry& entry = index_.entries[position_++];
    const BagChunk& chunk = index_.chunks[entry.chunk];
    if (read(entry, message)) {
      message.index_time = entry.time;
      message.offset = chunk.offset + (chunk.compressed() ? 0 : entry.offset);
      return true;
    }
    // One note for each chunk is enough: damage takes the messages behind it along.
    const bool noted = !index_.damage.empty() && index_.damage.back().offset == chunk.offset;
    if (!noted) {
      index_.damage.push_back({chunk.offset, "a chunk holds unreadable messages"});
    }
  }
  return false;
}

bool BagReader::read(const BagIndexEntry& entry, BagMessage& message) {
  const BagChunk& chunk = index_.chunks[entry.chunk];
  message.chunk = nullptr;
  if (!chunk.compressed()) {
    return readMessage(file_, chunk.offset + entry.offset, message);
  }
  const ChunkBytes& bytes = decompressed(entry);
  if (!readMessage(MemorySource(bytes.data.get(), bytes.size), entry.offset, message)) {
    return false;
  }
  // A time that was put right must be right in the output, too.
  if (bytes.copyable && !chunk.cut && chunk.full_size > 0 && keyOf(message.time) == entry.time &&
      message.time >= ros::TIME_MIN) {
    message.chunk = &chunk;
    message.place = static_cast<std::uint32_t>(entry.offset);
  }
  return true;
}

ros::Duration BagReader::duration() const {
  if (index_.entries.empty()) {
    return {};
  }
  const auto time = [](const BagIndexEntry& entry) {
    return soundTime(static_cast<std::uint32_t>(entry.time >> 32),
                     static_cast<std::uint32_t>(entry.time));
  };
  const ros::Time first = time(index_.entries.front());
  const ros::Time last = time(index_.entries.back());
  // A ros::Duration holds half of what lies between two times.
  return last.sec - first.sec < INT32_MAX ? last - first : ros::DURATION_MAX;
}

std::string BagReader::compression() const {
  return index_.chunks.empty() ? "none" : index_.chunks.front().compression;
}

const ChunkBytes& BagReader::decompressed(const BagIndexEntry& entry) {
  for (auto cached = cache_.begin(); cached != cache_.end(); ++cached) {
    if (cached->chunk == entry.chunk) {
      cache_.splice(cache_.begin(), cache_, cached);
      return cache_.front().bytes;
    }
  }
  // Those that nobody needs any more go first: the next chunk then takes memory that lies in the
  // processor's caches.
  for (auto cached = cache_.begin(); cached != cache_.end();) {
    const bool is_over = index_.chunks[cached->chunk].last_time < entry.time;
    cached = is_over ? drop(cached) : std::next(cached);
  }
  cache_.push_front({entry.chunk, readChunk(file_, index_.chunks[entry.chunk])});
  cached_bytes_ += cache_.front().bytes.size;
  while (cached_bytes_ > kMaxCachedBytes && cache_.size() > 1) {
    drop(std::prev(cache_.end()));
  }
  return cache_.front().bytes;
}

std::list<BagReader::CachedChunk>::iterator BagReader::drop(
    std::list<CachedChunk>::iterator cached) {
  cached_bytes_ -= cached->bytes.size;
  return cache_.erase(cached);
}

bool BagReader::readMessage(const ByteSource& source, std::uint64_t offset, BagMessage& message) {
  const std::optional<Record> record = readRecord(source, offset, header_scratch_);
  if (!record || record->kind != RecordKind::kMessage) {
    return false;
  }
  const std::optional<std::uint32_t> id = record->header.number<std::uint32_t>("conn");
  const std::optional<std::uint64_t> time = record->header.number<std::uint64_t>("time");
  const auto connection = id ? index_.connections.find(*id) : index_.connections.end();
  if (connection == index_.connections.end() || !time) {
    return false;
  }
  message.data = source.read(record->data_offset, record->data_size, data_scratch_);
  if (message.data == nullptr) {
    return false;
  }
  message.connection = &connection->second;
  message.size = record->data_size;
  // The record's own time: seconds in the low half, nanoseconds in the high one.
  message.time =
      soundTime(static_cast<std::uint32_t>(*time), static_cast<std::uint32_t>(*time >> 32));
  return true;
}

}  // namespace fast_edi
