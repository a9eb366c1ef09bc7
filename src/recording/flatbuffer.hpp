/// \file
/// Tables of the FlatBuffers format, read without trusting an offset.
///
/// A reader of our own, since it is smaller than what the library needs: code generated for just
/// one version of it, those of Debian and Ubuntu differing, and a pass over the whole buffer
/// (flatbuffers::Verifier) before the first field. It also reads what is left of a cut buffer.
///
/// Layout (https://flatbuffers.dev/internals): little endian; a table begins with the distance back
/// to its vtable {u16 its size, u16 size of the table, u16 offset of each field in the table};
/// strings, vectors and tables within tables lie ahead, at the distance that the field holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace fast_edi {

constexpr std::size_t kSizePrefixBytes = 4;  ///< ahead of a buffer that says its own size
constexpr std::size_t kReferenceBytes = 4;   ///< the distance to a string, vector or table

/// Bytes that may be shorter than what lies in them says.
struct FlatBytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;

  /// Nothing when the number is not wholly within.
  template <typename Number>
  std::optional<Number> number(std::uint64_t offset) const {
    if (offset > size || sizeof(Number) > size - offset) {
      return std::nullopt;
    }
    Number value;
    std::memcpy(&value, data + offset, sizeof(value));
    return value;
  }
};

/// Elements of a vector that are really there.
struct FlatVector {
  const std::uint8_t* data = nullptr;
  std::size_t count = 0;
  bool complete = true;  ///< all that the vector claims
};

/// A table within bytes that outlive it.
class FlatTable {
 public:
  /// Nothing when there is no sound table at \p offset.
  static std::optional<FlatTable> at(FlatBytes bytes, std::uint64_t offset);
  /// The root table of a buffer behind its size; nothing when it is unsound or has another
  /// identifier.
  static std::optional<FlatTable> root(FlatBytes size_prefixed, std::string_view identifier);

  /// \param absent for a field that was left out, or lies outside
  template <typename Number>
  Number number(int field, Number absent) const {
    const std::uint64_t offset = fieldOffset(field);
    return offset == 0 ? absent : bytes_.number<Number>(offset).value_or(absent);
  }
  /// Elements of \p element_bytes each; none for an absent field.
  FlatVector vector(int field, std::size_t element_bytes) const;
  std::string_view text(int field) const;
  /// Element \p index of a vector of tables. \pre index < vector(field, 4).count
  std::optional<FlatTable> element(int field, std::size_t index) const;
  /// Where a struct lies that is stored in the table itself; nullptr when it is absent or cut.
  const std::uint8_t* structure(int field, std::size_t bytes) const;

 private:
  FlatTable(FlatBytes bytes, std::uint64_t table, std::uint64_t vtable, std::uint16_t vtable_bytes)
      : bytes_(bytes), table_(table), vtable_(vtable), vtable_bytes_(vtable_bytes) {}

  /// In the buffer; 0 = absent.
  std::uint64_t fieldOffset(int field) const;

  FlatBytes bytes_;
  std::uint64_t table_;
  std::uint64_t vtable_;
  std::uint16_t vtable_bytes_;
};

}  // namespace fast_edi
