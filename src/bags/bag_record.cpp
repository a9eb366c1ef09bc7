#include "fast_edi/bags/bag_record.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

constexpr std::size_t kLengthBytes = sizeof(std::uint32_t);
/// Read at once in the hope that a header and both lengths are within: most are below 64 bytes.
constexpr std::size_t kHeaderGuessBytes = 256;
/// Longer headers are taken for damage: the only text in one is a topic's name.
constexpr std::uint32_t kMaxHeaderBytes = 1 << 20;
constexpr std::size_t kSearchBlockBytes = 1 << 20;
/// A chunk's header has three fields (op, compression, size), so `op` starts near its beginning.
constexpr std::size_t kMaxChunkHeaderBytes = 128;

std::uint32_t length(const std::uint8_t* bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

std::string_view view(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

bool isKnown(std::uint8_t kind) {
  return kind >= static_cast<std::uint8_t>(RecordKind::kMessage) &&
         kind <= static_cast<std::uint8_t>(RecordKind::kConnection);
}

}  // namespace

std::optional<RecordHeader> RecordHeader::parse(std::string_view bytes) {
  RecordHeader header;
  while (!bytes.empty()) {
    if (bytes.size() < kLengthBytes) {
      return std::nullopt;
    }
    const std::uint32_t field_bytes = length(reinterpret_cast<const std::uint8_t*>(bytes.data()));
    bytes.remove_prefix(kLengthBytes);
    if (field_bytes > bytes.size()) {
      return std::nullopt;
    }
    const std::string_view field = bytes.substr(0, field_bytes);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return std::nullopt;
    }
    header.fields_.emplace_back(field.substr(0, equals), field.substr(equals + 1));
    bytes.remove_prefix(field_bytes);
  }
  return header;
}

std::optional<std::string_view> RecordHeader::text(std::string_view name) const {
  for (const auto& [field, value] : fields_) {
    if (field == name) {
      return value;
    }
  }
  return std::nullopt;
}

std::optional<Record> readRecord(const ByteSource& source, std::uint64_t offset,
                                 std::vector<std::uint8_t>& scratch) {
  if (offset >= source.size()) {
    return std::nullopt;
  }
  std::size_t available =
      static_cast<std::size_t>(std::min<std::uint64_t>(kHeaderGuessBytes, source.size() - offset));
  const std::uint8_t* bytes = source.read(offset, available, scratch);
  if (bytes == nullptr || available < kLengthBytes) {
    return std::nullopt;
  }
  const std::uint32_t header_bytes = length(bytes);
  if (header_bytes == 0 || header_bytes > kMaxHeaderBytes) {
    return std::nullopt;
  }
  const std::size_t needed = kLengthBytes + header_bytes + kLengthBytes;
  if (needed > available) {
    bytes = source.read(offset, needed, scratch);
    if (bytes == nullptr) {
      return std::nullopt;
    }
  }
  std::optional<RecordHeader> header =
      RecordHeader::parse(view(bytes + kLengthBytes, header_bytes));
  const std::optional<std::uint8_t> kind =
      header ? header->number<std::uint8_t>("op") : std::nullopt;
  if (!kind || !isKnown(*kind)) {
    return std::nullopt;
  }
  Record record;
  record.header = std::move(*header);
  record.kind = static_cast<RecordKind>(*kind);
  record.data_offset = offset + needed;
  record.data_size = length(bytes + kLengthBytes + header_bytes);
  return record;
}

std::optional<std::uint64_t> findChunkRecord(const ByteSource& source, std::uint64_t offset) {
  // The field "op" of a chunk, with its length in front.
  constexpr std::string_view kOpField("\x04\x00\x00\x00op=\x05", 8);
  std::vector<std::uint8_t> block_memory;
  std::vector<std::uint8_t> record_memory;
  const std::uint64_t first = offset;
  while (offset < source.size()) {
    const std::size_t count = static_cast<std::size_t>(
        std::min<std::uint64_t>(kSearchBlockBytes, source.size() - offset));
    const std::uint8_t* bytes = source.read(offset, count, block_memory);
    if (bytes == nullptr) {
      // An unreadable sector: what lies behind it may still be readable.
      offset += count;
      continue;
    }
    const std::string_view block = view(bytes, count);
    for (std::size_t found = block.find(kOpField); found != std::string_view::npos;
         found = block.find(kOpField, found + 1)) {
      const std::uint64_t op_at = offset + found;
      const std::uint64_t earliest =
          std::max(first, op_at - std::min<std::uint64_t>(op_at, kMaxChunkHeaderBytes));
      for (std::uint64_t start = earliest; start + kLengthBytes <= op_at; ++start) {
        const std::optional<Record> record = readRecord(source, start, record_memory);
        if (record && record->kind == RecordKind::kChunk && record->header.text("compression")) {
          return start;
        }
      }
    }
    if (count < kSearchBlockBytes) {
      break;
    }
    offset += count - (kOpField.size() - 1);  // the field may straddle two blocks
  }
  return std::nullopt;
}

}  // namespace fast_edi
