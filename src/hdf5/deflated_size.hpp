/// \file
/// How much compressed bytes hold, found out in little memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fast_edi {

/// Whether \p deflated (zlib's format) holds exactly \p size bytes.
bool inflatesTo(const std::vector<std::uint8_t>& deflated, std::size_t size);

}  // namespace fast_edi
