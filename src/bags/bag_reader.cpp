#include "fast_edi/bags/bag_reader.hpp"

#include <algorithm>
#include <cstdint>
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

}  // namespace

BagReader::BagReader(const std::string& path) : file_(path), index_(buildBagIndex(file_, path)) {}

bool BagReader::next(BagMessage& message) {
  while (position_ < index_.entries.size()) {
    const BagIndexEntry& entry = index_.entries[position_++];
    const BagChunk& chunk = index_.chunks[entry.chunk];
    bool read = false;
    if (chunk.compressed()) {
      const ChunkBytes& bytes = decompressed(entry.chunk);
      read = readMessage(MemorySource(bytes.data.get(), bytes.size), entry.offset, message);
    } else {
      read = readMessage(file_, chunk.offset + entry.offset, message);
    }
    if (read) {
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

const ChunkBytes& BagReader::decompressed(std::uint32_t chunk) {
  for (auto cached = cache_.begin(); cached != cache_.end(); ++cached) {
    if (cached->chunk == chunk) {
      cache_.splice(cache_.begin(), cache_, cached);
      return cache_.front().bytes;
    }
  }
  cache_.push_front({chunk, readChunk(file_, index_.chunks[chunk])});
  cached_bytes_ += cache_.front().bytes.size;
  while (cached_bytes_ > kMaxCachedBytes && cache_.size() > 1) {
    cached_bytes_ -= cache_.back().bytes.size;
    cache_.pop_back();
  }
  return cache_.front().bytes;
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
