#include "recording/flatbuffer.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

constexpr std::size_t kIdentifierOffset = 8;  ///< behind the size and the root's offset
constexpr std::size_t kIdentifierBytes = 4;
constexpr std::size_t kVtableHeaderBytes = 4;  ///< both sizes

}  // namespace

std::optional<FlatTable> FlatTable::at(FlatBytes bytes, std::uint64_t offset) {
  const std::optional<std::int32_t> back = bytes.number<std::int32_t>(offset);
  if (!back) {
    return std::nullopt;
  }
  const std::int64_t vtable = static_cast<std::int64_t>(offset) - *back;
  if (vtable < 0) {
    return std::nullopt;
  }
  const auto place = static_cast<std::uint64_t>(vtable);
  const std::optional<std::uint16_t> size = bytes.number<std::uint16_t>(place);
  if (!size || *size < kVtableHeaderBytes || place + *size > bytes.size) {
    return std::nullopt;
  }
  return FlatTable(bytes, offset, place, *size);
}

std::optional<FlatTable> FlatTable::root(FlatBytes size_prefixed, std::string_view identifier) {
  const FlatBytes& bytes = size_prefixed;
  if (bytes.size < kIdentifierOffset + kIdentifierBytes ||
      std::memcmp(bytes.data + kIdentifierOffset, identifier.data(), kIdentifierBytes) != 0) {
    return std::nullopt;
  }
  const std::optional<std::uint32_t> offset = bytes.number<std::uint32_t>(kSizePrefixBytes);
  return offset ? at(bytes, kSizePrefixBytes + std::uint64_t{*offset}) : std::nullopt;
}

std::uint64_t FlatTable::fieldOffset(int field) const {
  const std::uint64_t entry =
      kVtableHeaderBytes + static_cast<std::uint64_t>(field) * sizeof(std::uint16_t);
  if (entry + sizeof(std::uint16_t) > vtable_bytes_) {
    return 0;
  }
  const std::uint16_t offset = bytes_.number<std::uint16_t>(vtable_ + entry).value_or(0);
  return offset == 0 ? 0 : table_ + offset;
}

FlatVector FlatTable::vector(int field, std::size_t element_bytes) const {
  const std::uint64_t offset = fieldOffset(field);
  if (offset == 0) {
    return {};
  }
  const std::optional<std::uint32_t> ahead = bytes_.number<std::uint32_t>(offset);
  const std::optional<std::uint32_t> count =
      ahead ? bytes_.number<std::uint32_t>(offset + *ahead) : std::nullopt;
  if (!count) {
    return {nullptr, 0, false};
  }
  const std::uint64_t begin = offset + *ahead + sizeof(std::uint32_t);
  const std::uint64_t there = (bytes_.size - begin) / element_bytes;
  return {bytes_.data + begin, static_cast<std::size_t>(std::min<std::uint64_t>(*count, there)),
          *count <= there};
}

std::string_view FlatTable::text(int field) const {
  const FlatVector characters = vector(field, 1);
  return {reinterpret_cast<const char*>(characters.data), characters.count};
}

std::optional<FlatTable> FlatTable::element(int field, std::size_t index) const {
  const FlatVector references = vector(field, kReferenceBytes);
  const std::uint64_t place = static_cast<std::uint64_t>(references.data - bytes_.data) +
                              std::uint64_t{index} * kReferenceBytes;
  const std::optional<std::uint32_t> ahead = bytes_.number<std::uint32_t>(place);
  return ahead ? at(bytes_, place + *ahead) : std::nullopt;
}

const std::uint8_t* FlatTable::structure(int field, std::size_t bytes) const {
  const std::uint64_t offset = fieldOffset(field);
  return offset == 0 || offset > bytes_.size || bytes > bytes_.size - offset ? nullptr
                                                                             : bytes_.data + offset;
}

}  // namespace fast_edi
