/// \file
/// The first pass over an MCAP file: where its chunks lie, and which times they have.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/mcap_chunk_reader.hpp"
#include "recording/mcap_records.hpp"
#include "recording/mcap_topics.hpp"

namespace fast_edi {

/// A chunk, or a message outside of chunks.
struct McapPart {
  std::uint64_t begin_ns = 0;
  McapRecord record;
  bool is_chunk = false;
};

struct McapIndex {
  std::vector<McapPart> parts;  ///< in the order of their times
  std::string compression;      ///< of the first chunk
  std::optional<std::uint64_t> expected_messages;
  std::vector<RecordingDamage> damage;  ///< what could not be read
};

/// Goes over the records of a file, without what is in its chunks. Behind damage it goes on at the
/// next chunk. Only where the file has no end, as that of an interrupted recorder, chunks are
/// opened for their topics.
/// \param begin offset of the first record
/// \param topics takes those that are found
McapIndex readMcapIndex(const ByteSource& file, std::uint64_t begin, McapChunkReader& chunks,
                        McapTopics& topics);

}  // namespace fast_edi
