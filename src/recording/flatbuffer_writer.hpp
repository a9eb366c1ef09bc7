/// \file
/// Writes FlatBuffers whose size stands in front of them; see flatbuffer.hpp.
///
/// Everything that a table refers to is written behind it, in the order of the calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace fast_edi {

class FlatBufferWriter {
 public:
  /// A field of a table.
  struct Field {
    int index = 0;
    std::vector<std::uint8_t> bytes;  ///< as stored
    std::size_t alignment = 1;
  };
  /// Where a field lies that will refer to what is written later.
  using Reference = std::size_t;

  template <typename Number>
  static Field number(int index, Number value) {
    Field field{index, std::vector<std::uint8_t>(sizeof(value)), sizeof(value)};
    std::memcpy(field.bytes.data(), &value, sizeof(value));
    return field;
  }
  static Field reference(int index) { return number<std::uint32_t>(index, 0); }

  /// \param identifier four characters
  explicit FlatBufferWriter(std::string_view identifier);

  /// Writes a table.
  /// \param fields in the order of their indices
  /// \param places where each of them came to lie in bytes()
  /// \return where it begins
  std::size_t table(const std::vector<Field>& fields, std::vector<Reference>& places);
  /// Makes \p table the root.
  void setRoot(std::size_t table);
  /// Writes a vector of \p count elements, and makes \p from refer to it.
  /// \return where the elements begin
  std::size_t vector(Reference from, const void* elements, std::size_t count,
                     std::size_t element_bytes, std::size_t alignment);
  /// A string, with the zero behind it.
  void text(Reference from, std::string_view text);
  /// A vector of references to tables that are still to be written.
  std::vector<Reference> references(Reference from, std::size_t count);
  /// Makes \p from refer to \p target.
  void refer(Reference from, std::size_t target);

  /// The whole buffer, its size in front.
  const std::vector<std::uint8_t>& finish();
  /// As it is so far.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  /// Fills up until the size is a multiple of \p alignment, plus \p rest.
  void align(std::size_t alignment, std::size_t rest = 0);
  template <typename Number>
  void put(std::size_t place, Number value) {
    std::memcpy(bytes_.data() + place, &value, sizeof(value));
  }

  std::vector<std::uint8_t> bytes_;
};

}  // namespace fast_edi
