/// \file
/// Messages of ROS 2 as they lie in recordings: CDR, the common data representation of DDS (OMG
/// DDSI-RTPS 2.5, section 10; the plain one, "XCDR1"). Nothing is trusted that a message says.
///
/// Four bytes tell the byte order. Behind them each number is aligned to its own size, counted from
/// there; sequences and strings have a 32-bit count in front, and strings a zero at their end.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace fast_edi {

/// \return the bytes of \p value in the other order
template <typename Number>
Number byteSwapped(Number value) {
  std::uint8_t bytes[sizeof(Number)];
  std::memcpy(bytes, &value, sizeof(value));
  std::reverse(bytes, bytes + sizeof(value));
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

/// Bytes of a sequence, within the message.
struct CdrBytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Reads field by field. After the first one that lies beyond the end, ok() is false and all that
/// is read is 0 or empty.
class CdrReader {
 public:
  /// \param data a whole message, which must outlive this
  CdrReader(const std::uint8_t* data, std::size_t size);

  /// All that was read so far was there.
  bool ok() const { return ok_; }
  bool isBigEndian() const { return big_endian_; }
  /// The next byte.
  const std::uint8_t* here() const { return body_ + place_; }
  /// Bytes that were not read yet.
  std::size_t rest() const { return size_ - place_; }

  template <typename Number>
  Number number() {
    align(sizeof(Number));
    if (!ok_ || rest() < sizeof(Number)) {
      ok_ = false;
      return Number{};
    }
    Number value;
    std::memcpy(&value, body_ + place_, sizeof(value));
    place_ += sizeof(value);
    return big_endian_ ? byteSwapped(value) : value;
  }
  std::string_view text();
  /// A sequence of bytes.
  CdrBytes bytes();
  /// A sequence of bytes that may be cut: as many as are there.
  CdrBytes availableBytes();
  /// \p count numbers of 8 bytes.
  void doubles(double* values, std::size_t count);
  /// Leaves out \p count numbers of 8 bytes.
  void skipDoubles(std::size_t count);

 private:
  void align(std::size_t bytes);

  const std::uint8_t* body_ = nullptr;  ///< behind the first four bytes
  std::size_t size_ = 0;                ///< of the body
  std::size_t place_ = 0;               ///< in the body
  bool big_endian_ = false;
  bool ok_ = true;
};

}  // namespace fast_edi
