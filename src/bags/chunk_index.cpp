#include "bags/chunk_index.hpp"

#include <algorithm>

#include "bags/record_bytes.hpp"

namespace fast_edi {
namespace {

/// Of index and chunk info records alike.
constexpr std::uint32_t kIndexVersion = 1;

}  // namespace

void ChunkIndex::add(std::uint32_t connection, const ros::Time& time, std::uint32_t offset) {
  Entries& entries = connections_[connection];
  ++entries.count;
  appendTime(entries.bytes, time);
  appendNumber(entries.bytes, offset);
  first_ = std::min(first_, time);
  last_ = std::max(last_, time);
}

void ChunkIndex::appendRecords(std::string& bytes) const {
  for (const auto& [connection, entries] : connections_) {
    appendRecord(bytes,
                 HeaderBytes(RecordKind::kIndex)
                     .add("ver", kIndexVersion)
                     .add("conn", connection)
                     .add("count", entries.count),
                 entries.bytes);
  }
}

void ChunkIndex::appendChunkInfo(std::string& bytes, std::uint64_t position) const {
  std::string counts;
  for (const auto& [connection, entries] : connections_) {
    appendNumber(counts, connection);
    appendNumber(counts, entries.count);
  }
  appendRecord(bytes,
               HeaderBytes(RecordKind::kChunkInfo)
                   .add("ver", kIndexVersion)
                   .add("chunk_pos", position)
                   .add("start_time", first_)
                   .add("end_time", last_)
                   .add("count", static_cast<std::uint32_t>(connections_.size())),
               counts);
}

}  // namespace fast_edi
