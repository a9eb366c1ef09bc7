#include "recording/mcap_chunk_reader.hpp"

#include <cstddef>
#include <optional>

#include <boost/crc.hpp>

#include "recording/rosbag2_storage.hpp"

namespace fast_edi {

std::string McapChunkReader::read(const McapRecord& chunk, RawBytes& records) {
  records.clear();
  const auto size = static_cast<std::size_t>(chunk.size);
  const std::uint8_t* bytes = file_.read(chunk.content, size, scratch_);
  if (bytes == nullptr) {
    return "cannot be read";
  }
  const std::optional<McapChunkHeader> header = mcapChunkHeader(bytes, size, chunk.size);
  if (!header) {
    return "the header of a chunk is damaged";
  }
  const std::optional<Compression> compression = mcapCompression(header->compression);
  if (!compression) {
    return "a chunk with the compression \"" + header->compression +
           "\", expected none, lz4 or zstd";
  }
  std::string fault =
      decompressor_.run(*compression, bytes + header->header_bytes, size - header->header_bytes,
                        Rosbag2Storage::kMaxMessageBytes, records);
  if (!fault.empty()) {
    return fault;
  }
  if (records.size() != header->records_bytes) {
    return "a chunk of " + mcapSizeText(records.size()) + ", expected " +
           mcapSizeText(header->records_bytes);
  }
  if (header->checksum != 0) {
    boost::crc_32_type checksum;
    checksum.process_bytes(records.data(), records.size());
    if (checksum.checksum() != header->checksum) {
      return "the checksum of a chunk does not fit: what is in it may be wrong";
    }
  }
  return {};
}

}  // namespace fast_edi
