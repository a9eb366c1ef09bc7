#include "bags/copied_chunks.hpp"

#include <tuple>

namespace fast_edi {

void CopiedChunks::add(const BagMessage& message, const Write& write) {
  const BagChunk& chunk = *message.chunk;
  endBefore(std::uint64_t{message.time.sec} << 32 | message.time.nsec, chunk.offset, write);
  Begun& begun = begun_[chunk.offset];
  begun.chunk = &chunk;
  begun.index.add(message.connection->id, message.time, message.place);
}

void CopiedChunks::endBefore(std::uint64_t time, std::uint64_t offset, const Write& write) {
  while (!begun_.empty()) {
    const auto first = begun_.begin();
    const BagChunk& chunk = *first->second.chunk;
    if (std::tie(chunk.last_time, chunk.offset) >= std::tie(time, offset)) {
      break;
    }
    write(chunk, first->second.index);
    begun_.erase(first);
  }
}

void CopiedChunks::finish(const Write& write) {
  for (const auto& [offset, begun] : begun_) {
    write(*begun.chunk, begun.index);
  }
  begun_.clear();
}

}  // namespace fast_edi
