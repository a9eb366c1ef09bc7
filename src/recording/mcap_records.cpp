#include "recording/mcap_records.hpp"

#include "recording/number_at.hpp"

namespace fast_edi {

std::string McapFields::text() {
  const auto count = number<std::uint32_t>();
  if (!ok_ || count > size_ - place_) {
    ok_ = false;
    return {};
  }
  place_ += count;
  return {reinterpret_cast<const char*>(data_ + place_ - count), count};
}

std::optional<McapRecord> mcapRecordAt(const ByteSource& file, std::uint64_t offset,
                                       std::vector<std::uint8_t>& scratch) {
  const std::uint8_t* bytes = file.read(offset, kMcapRecordHeaderBytes, scratch);
  if (bytes == nullptr) {
    return std::nullopt;
  }
  McapRecord record;
  record.kind = bytes[0];
  record.size = numberAt<std::uint64_t>(bytes + 1);
  record.content = offset + kMcapRecordHeaderBytes;
  const bool known = (record.kind >= kMcapHeader && record.kind <= kMcapDataEnd) ||
                     record.kind >= kMcapFirstPrivate;
  return known && record.size <= file.size() - record.content ? std::optional(record)
                                                              : std::nullopt;
}

std::optional<McapRecord> mcapRecordAt(const RawBytes& records, std::size_t place) {
  if (records.size() - place < kMcapRecordHeaderBytes) {
    return std::nullopt;
  }
  McapRecord record;
  record.kind = records[place];
  record.size = numberAt<std::uint64_t>(records.data() + place + 1);
  record.content = place + kMcapRecordHeaderBytes;
  return record.size <= records.size() - record.content ? std::optional(record) : std::nullopt;
}

std::optional<McapChunkHeader> mcapChunkHeader(const std::uint8_t* data, std::size_t there,
                                               std::uint64_t chunk_bytes) {
  McapFields fields(data, there);
  McapChunkHeader header;
  header.begin_ns = fields.number<std::uint64_t>();
  fields.number<std::uint64_t>();  // its end
  header.records_bytes = fields.number<std::uint64_t>();
  header.checksum = fields.number<std::uint32_t>();
  header.compression = fields.text();
  const auto stored = fields.number<std::uint64_t>();
  header.header_bytes = fields.place();
  if (!fields.ok() || header.compression.size() > kMaxMcapCompressionName ||
      chunk_bytes < header.header_bytes || stored != chunk_bytes - header.header_bytes) {
    return std::nullopt;
  }
  return header;
}

std::optional<Compression> mcapCompression(const std::string& name) {
  if (name.empty()) {
    return Compression::kNone;
  }
  if (name == "lz4") {
    return Compression::kLz4;
  }
  return name == "zstd" ? std::optional(Compression::kZstd) : std::nullopt;
}

std::string mcapSizeText(std::uint64_t size) {
  return std::to_string(size) + " bytes";
}

}  // namespace fast_edi
