/// \file
/// Records of the rosbag 2.0 format (http://wiki.ros.org/Bags/Format/2.0), read without trusting a
/// single length: what is malformed or cut is said, never followed.
///
///     record = <header length: u32> <header> <data length: u32> <data>
///     header = ( <field length: u32> <name> '=' <value> ) ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"

namespace fast_edi {

/// The named fields of a record header.
class RecordHeader {
 public:
  /// Nothing when the fields do not fill \p bytes exactly.
  static std::optional<RecordHeader> parse(std::string_view bytes);

  std::optional<std::string_view> text(std::string_view name) const;

  /// A little-endian number; nothing when the field is absent or of another length.
  template <typename Number>
  std::optional<Number> number(std::string_view name) const {
    const std::optional<std::string_view> value = text(name);
    if (!value || value->size() != sizeof(Number)) {
      return std::nullopt;
    }
    Number number;
    std::memcpy(&number, value->data(), sizeof(Number));
    return number;
  }

  /// All fields, e.g. of a connection record's data, which has the same form.
  const std::vector<std::pair<std::string_view, std::string_view>>& fields() const {
    return fields_;
  }

 private:
  std::vector<std::pair<std::string_view, std::string_view>> fields_;
};

/// What the `op` field says a record is.
enum class RecordKind : std::uint8_t {
  kMessage = 0x02,
  kFileHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

/// Where a record lies in its source. Its data may reach beyond the end: see complete().
struct Record {
  RecordHeader header;  ///< points into the scratch memory given to readRecord()
  RecordKind kind = RecordKind::kMessage;
  std::uint64_t data_offset = 0;
  std::uint32_t data_size = 0;

  std::uint64_t end() const { return data_offset + data_size; }
  bool complete(const ByteSource& source) const { return end() <= source.size(); }
};

/// The record that starts at \p offset; nothing when there is none with a well-formed header.
/// \param scratch holds the header; keep it unchanged as long as the record is used
std::optional<Record> readRecord(const ByteSource& source, std::uint64_t offset,
                                 std::vector<std::uint8_t>& scratch);

/// Offset of the first chunk record at or after \p offset; nothing when there is none. Finds the
/// way back into a file after damage.
std::optional<std::uint64_t> findChunkRecord(const ByteSource& source, std::uint64_t offset);

}  // namespace fast_edi
