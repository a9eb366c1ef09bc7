/// \file
/// LZ4 and ZSTD frames (those of their own file formats), as AEDAT4 and others have them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/base/raw_bytes.hpp"

namespace fast_edi {

enum class Compression { kNone, kLz4, kZstd };

const char* toString(Compression compression);

/// Keeps its state and memory from packet to packet.
class Decompressor {
 public:
  Decompressor();
  ~Decompressor();
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  /// Decompresses up to the first damage, and no further than \p max_bytes.
  /// \param output what came of it; its memory is used again
  /// \return what is wrong; empty if nothing is
  std::string run(Compression compression, const std::uint8_t* data, std::size_t size,
                  std::size_t max_bytes, RawBytes& output);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A whole frame. \pre compression is not kNone
/// \throws std::runtime_error when the library fails
void compress(Compression compression, const std::uint8_t* data, std::size_t size,
              std::vector<std::uint8_t>& output);

}  // namespace fast_edi
