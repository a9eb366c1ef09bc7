#include "recording/mcap_index.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "recording/damage_notes.hpp"
#include "recording/number_at.hpp"
#include "recording/rosbag2_storage.hpp"

namespace fast_edi {
namespace {

/// Schemas and channels are no larger.
constexpr std::size_t kMaxDescriptionBytes = std::size_t{16} << 20;
/// How far a search for the next chunk reads at once.
constexpr std::size_t kSearchBlockBytes = std::size_t{1} << 20;

/// Where reading goes on behind damage: the next chunk, or the end of the file.
std::uint64_t findChunk(const ByteSource& file, std::uint64_t from) {
  constexpr std::size_t kNeeded = kMcapRecordHeaderBytes + kMcapChunkHeaderBytes;
  std::vector<std::uint8_t> block;
  while (from < file.size() && file.size() - from >= kNeeded) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(kSearchBlockBytes, file.size() - from));
    const std::uint8_t* bytes = file.read(from, count, block);
    if (bytes == nullptr) {
      break;
    }
    for (std::size_t i = 0; i + kNeeded <= count; ++i) {
      if (bytes[i] != kMcapChunk) {
        continue;
      }
      const auto size = numberAt<std::uint64_t>(bytes + i + 1);
      if (size <= file.size() - from - i - kMcapRecordHeaderBytes &&
          mcapChunkHeader(bytes + i + kMcapRecordHeaderBytes, count - i - kMcapRecordHeaderBytes,
                          size)) {
        return from + i;
      }
    }
    from += count - kNeeded + 1;
  }
  return file.size();
}

class McapIndexReader {
 public:
  McapIndexReader(const ByteSource& file, McapChunkReader& chunks, McapTopics& topics)
      : file_(file), chunks_(chunks), topics_(topics) {}

  McapIndex read(std::uint64_t offset) {
    while (offset < file_.size() && !complete_) {
      const std::optional<McapRecord> record = mcapRecordAt(file_, offset, scratch_);
      if (!record) {
        note(offset, "expected a record of MCAP that ends within the file, " +
                         mcapSizeText(file_.size() - offset) + " are left");
        offset = findChunk(file_, offset + 1);
        continue;
      }
      takeRecord(*record);
      offset = record->end();
    }
    if (!complete_) {
      note(file_.size(), "expected a footer: the file is cut, or its recorder was interrupted");
      findTopicsInChunks();
    } else if (expected_chunks_.value_or(found_chunks_) != found_chunks_) {
      note(file_.size(), std::to_string(found_chunks_) + " chunks are found, expected " +
                             std::to_string(*expected_chunks_));
    }
    std::stable_sort(index_.parts.begin(), index_.parts.end(),
                     [](const McapPart& a, const McapPart& b) { return a.begin_ns < b.begin_ns; });
    return std::move(index_);
  }

 private:
  void note(std::uint64_t offset, const std::string& what) {
    noteDamage(index_.damage, {offset, what});
  }

  void takeRecord(const McapRecord& record) {
    switch (record.kind) {
      case kMcapFooter:
        complete_ = true;
        break;
      case kMcapMessage:
      case kMcapChunk:
        addPart(record);
        break;
      case kMcapSchema:
      case kMcapChannel:
      case kMcapStatistics:
        takeDescription(record);
        break;
      default:
        break;
    }
  }

  /// Schemas, channels, numbers of all that is there.
  void takeDescription(const McapRecord& record) {
    const std::uint8_t* content =
        record.size <= kMaxDescriptionBytes
            ? file_.read(record.content, static_cast<std::size_t>(record.size), scratch_)
            : nullptr;
    if (content == nullptr) {
      note(record.content, "a description of " + mcapSizeText(record.size) + ": left out");
      return;
    }
    const auto size = static_cast<std::size_t>(record.size);
    if (record.kind != kMcapStatistics) {
      topics_.add(record.kind, content, size);
      return;
    }
    McapFields fields(content, size);
    const auto messages = fields.number<std::uint64_t>();
    fields.number<std::uint16_t>();  // schemas
    fields.number<std::uint32_t>();  // channels
    fields.number<std::uint32_t>();  // attachments
    fields.number<std::uint32_t>();  // metadata
    const auto chunks = fields.number<std::uint32_t>();
    if (fields.ok()) {
      index_.expected_messages = messages;
      expected_chunks_ = chunks;
    }
  }

  void addPart(const McapRecord& record) {
    McapPart part;
    part.record = record;
    part.is_chunk = record.kind == kMcapChunk;
    const auto there = static_cast<std::size_t>(
        std::min<std::uint64_t>(record.size, kMcapChunkHeaderBytes + kMaxMcapCompressionName));
    const std::uint8_t* bytes = file_.read(record.content, there, scratch_);
    if (bytes == nullptr || record.size > Rosbag2Storage::kMaxMessageBytes) {
      note(record.content, "a message or chunk of " + mcapSizeText(record.size) +
                               ", expected at most " +
                               mcapSizeText(Rosbag2Storage::kMaxMessageBytes) + ": left out");
      return;
    }
    if (part.is_chunk) {
      const std::optional<McapChunkHeader> header = mcapChunkHeader(bytes, there, record.size);
      if (!header) {
        note(record.content,
             "the header of a chunk of " + mcapSizeText(record.size) + " is damaged");
        return;
      }
      if (found_chunks_ == 0) {
        index_.compression = header->compression;
      }
      ++found_chunks_;
      part.begin_ns = header->begin_ns;
    } else {
      if (there < kMcapMessageHeaderBytes) {
        note(record.content, "a message of " + mcapSizeText(record.size) + ", expected at least " +
                                 mcapSizeText(kMcapMessageHeaderBytes));
        return;
      }
      part.begin_ns = numberAt<std::uint64_t>(bytes + kMcapMessageTime);
    }
    index_.parts.push_back(part);
  }

  void findTopicsInChunks() {
    RawBytes records;
    for (const McapPart& part : index_.parts) {
      if (!part.is_chunk) {
        continue;
      }
      chunks_.read(part.record, records);  // what is damaged is noted when it is read again
      std::size_t place = 0;
      while (const std::optional<McapRecord> record = mcapRecordAt(records, place)) {
        topics_.add(record->kind, records.data() + record->content,
                    static_cast<std::size_t>(record->size));
        place = static_cast<std::size_t>(record->end());
      }
    }
  }

  const ByteSource& file_;
  McapChunkReader& chunks_;
  McapTopics& topics_;
  McapIndex index_;
  std::vector<std::uint8_t> scratch_;
  bool complete_ = false;  ///< there is an end
  std::uint64_t found_chunks_ = 0;
  std::optional<std::uint64_t> expected_chunks_;
};

}  // namespace

McapIndex readMcapIndex(const ByteSource& file, std::uint64_t begin, McapChunkReader& chunks,
                        McapTopics& topics) {
  return McapIndexReader(file, chunks, topics).read(begin);
}

}  // namespace fast_edi
