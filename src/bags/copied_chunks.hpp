/// \file
/// Chunks of a bag on their way into another one, as they are.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "bags/chunk_index.hpp"
#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// Collects the messages of each chunk until all have come; only these will be in its index.
/// Messages come in the order of time, those of the same time in the order of the input's file.
/// Chunks are given out in that of the file as far as their times overlap.
class CopiedChunks {
 public:
  using Write = std::function<void(const BagChunk& chunk, const ChunkIndex& index)>;

  /// Writes the chunks that end before the message, then adds it to its own.
  /// \pre it has a chunk, and is not earlier than the one before
  void add(const BagMessage& message, const Write& write);
  /// Writes the chunks of which no message can follow one of this time, as BagIndexEntry has it, at
  /// this place of the input.
  void endBefore(std::uint64_t time, std::uint64_t offset, const Write& write);
  /// All that are left, with those of their messages that have come.
  void finish(const Write& write);

 private:
  struct Begun {
    const BagChunk* chunk = nullptr;
    ChunkIndex index;
  };

  std::map<std::uint64_t, Begun> begun_;  ///< by the place in the input
};

}  // namespace fast_edi
