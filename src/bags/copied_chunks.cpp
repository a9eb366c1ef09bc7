#include "bags/copied_chunks.hpp"

namespace fast_edi {

void CopiedChunks::add(const BagMessage& message, const Write& write) {
  const BagChunk& chunk = *message.chunk;
  const std::uint64_t now = std::uint64_t{message.time.sec} << 32 | message.time.nsec;
  while (!begun_.empty() && begun_.begin()->second.chunk->last_time < now) {
    const auto first = begun_.begin();
    write(*first->second.chunk, first->second.index);
    begun_.erase(first);
  }
  Begun& begun = begun_[chunk.offset];
  begun.chunk = &chunk;
  begun.index.add(message.connection->id, message.time, message.place);
}

void CopiedChunks::finish(const Write& write) {
  for (const auto& [offset, begun] : begun_) {
    write(*begun.chunk, begun.index);
  }
  begun_.clear();
}

}  // namespace fast_edi
