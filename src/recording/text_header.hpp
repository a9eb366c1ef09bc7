/// \file
/// The lines of text that AEDAT 2 and AEDAT 3 begin with.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"

namespace fast_edi {

/// Headers hold a camera's settings at most; what is longer is not one.
constexpr std::size_t kMaxTextHeaderBytes = std::size_t{4} << 20;

/// The beginning of \p file, in which a header ends.
/// \param scratch is where the text lies
/// \return as much as a header can have; empty when the file cannot be read
inline std::string_view textHeader(ByteSource& file, std::vector<std::uint8_t>& scratch) {
  const auto bytes =
      static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), kMaxTextHeaderBytes));
  const std::uint8_t* data = file.read(0, bytes, scratch);
  return {reinterpret_cast<const char*>(data), data != nullptr ? bytes : 0};
}

}  // namespace fast_edi
