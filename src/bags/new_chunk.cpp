#include "bags/new_chunk.hpp"

#include <limits>
#include <string_view>

#include "bags/bag_file.hpp"
#include "bags/record_bytes.hpp"
#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {

void NewChunk::add(const BagConnection& connection) {
  std::string record;
  appendConnection(record, connection);
  requireRoom(record.size());
  bytes_.append(record);
}

void NewChunk::add(std::uint32_t connection, const ros::Time& time, const std::uint8_t* data,
                   std::uint32_t size) {
  std::string head;
  appendRecordHead(
      head, HeaderBytes(RecordKind::kMessage).add("conn", connection).add("time", time), size);
  requireRoom(head.size() + size);
  index_.add(connection, time, static_cast<std::uint32_t>(bytes_.size()));
  bytes_.append(head);
  if (size > 0) {
    bytes_.append(reinterpret_cast<const char*>(data), size);
  }
}

void NewChunk::requireRoom(std::size_t more) const {
  if (bytes_.size() + more > std::numeric_limits<std::uint32_t>::max()) {
    throw BagError("a chunk cannot hold " + std::to_string(bytes_.size() + more) +
                   " bytes: its format ends at 4 GiB");
  }
}

}  // namespace fast_edi
