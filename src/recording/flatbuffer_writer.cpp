#include "recording/flatbuffer_writer.hpp"

#include <algorithm>

#include "recording/flatbuffer.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kRootOffset = 4;
constexpr std::size_t kFirstTable = 12;  ///< behind size, root and identifier
constexpr std::size_t kLargestAlignment = 8;

}  // namespace

FlatBufferWriter::FlatBufferWriter(std::string_view identifier) : bytes_(kFirstTable) {
  std::copy(identifier.begin(), identifier.end(), bytes_.begin() + 2 * kReferenceBytes);
}

void FlatBufferWriter::align(std::size_t alignment, std::size_t rest) {
  while (bytes_.size() % alignment != rest) {
    bytes_.push_back(0);
  }
}

std::size_t FlatBufferWriter::table(const std::vector<Field>& fields,
                                    std::vector<Reference>& places) {
  const std::size_t count = fields.empty() ? 0 : static_cast<std::size_t>(fields.back().index) + 1;
  const std::size_t vtable_bytes = (2 + count) * sizeof(std::uint16_t);
  // The table begins with four bytes of its own, so that its fields begin aligned to eight.
  while ((bytes_.size() + vtable_bytes) % kLargestAlignment != kReferenceBytes) {
    bytes_.push_back(0);
  }
  const std::size_t vtable = bytes_.size();
  bytes_.resize(vtable + vtable_bytes);
  const std::size_t table = bytes_.size();
  bytes_.resize(table + sizeof(std::int32_t));
  put(table, static_cast<std::int32_t>(table - vtable));
  places.assign(fields.size(), 0);
  for (const std::size_t alignment : {8, 4, 2, 1}) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (fields[i].alignment != alignment) {
        continue;
      }
      align(alignment);
      places[i] = bytes_.size();
      bytes_.insert(bytes_.end(), fields[i].bytes.begin(), fields[i].bytes.end());
      put(vtable + (2 + static_cast<std::size_t>(fields[i].index)) * sizeof(std::uint16_t),
          static_cast<std::uint16_t>(places[i] - table));
    }
  }
  put(vtable, static_cast<std::uint16_t>(vtable_bytes));
  put(vtable + sizeof(std::uint16_t), static_cast<std::uint16_t>(bytes_.size() - table));
  return table;
}

void FlatBufferWriter::setRoot(std::size_t table) {
  put(kRootOffset, static_cast<std::uint32_t>(table - kRootOffset));
}

std::size_t FlatBufferWriter::vector(Reference from, const void* elements, std::size_t count,
                                     std::size_t element_bytes, std::size_t alignment) {
  // The count lies in front of the elements, which are what is aligned.
  const std::size_t unit = std::max(alignment, kReferenceBytes);
  align(unit, unit - kReferenceBytes);
  refer(from, bytes_.size());
  const std::size_t begin = bytes_.size() + sizeof(std::uint32_t);
  bytes_.resize(begin + count * element_bytes);
  put(begin - sizeof(std::uint32_t), static_cast<std::uint32_t>(count));
  if (elements != nullptr && count > 0) {
    std::memcpy(bytes_.data() + begin, elements, count * element_bytes);
  }
  return begin;
}

void FlatBufferWriter::text(Reference from, std::string_view text) {
  vector(from, text.data(), text.size(), 1, 1);
  bytes_.push_back(0);
}

std::vector<FlatBufferWriter::Reference> FlatBufferWriter::references(Reference from,
                                                                      std::size_t count) {
  const std::size_t begin = vector(from, nullptr, count, kReferenceBytes, kReferenceBytes);
  std::vector<Reference> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    places[i] = begin + i * kReferenceBytes;
  }
  return places;
}

void FlatBufferWriter::refer(Reference from, std::size_t target) {
  put(from, static_cast<std::uint32_t>(target - from));
}

const std::vector<std::uint8_t>& FlatBufferWriter::finish() {
  put(0, static_cast<std::uint32_t>(bytes_.size() - kSizePrefixBytes));
  return bytes_;
}

}  // namespace fast_edi
