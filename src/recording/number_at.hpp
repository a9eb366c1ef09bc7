/// \file
#pragma once

#include <cstdint>
#include <cstring>

namespace fast_edi {

/// A little-endian number that need not be aligned. \pre all of its bytes exist
template <typename Number>
Number numberAt(const std::uint8_t* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  return number;
}

}  // namespace fast_edi
