#include "hdf5/deflated_size.hpp"

#include <array>

#include <zlib.h>

namespace fast_edi {

bool inflatesTo(const std::vector<std::uint8_t>& deflated, std::size_t size) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 15;
  z_stream stream = {};
  if (inflateInit(&stream) != Z_OK) {
    return false;
  }
  stream.next_in = const_cast<Bytef*>(deflated.data());  // zlib only reads
  stream.avail_in = static_cast<uInt>(deflated.size());
  std::array<Bytef, kBlockBytes> block = {};
  std::size_t found = 0;
  int status = Z_OK;
  while (status == Z_OK && found <= size) {
    stream.next_out = block.data();
    stream.avail_out = static_cast<uInt>(block.size());
    status = inflate(&stream, Z_NO_FLUSH);
    found += block.size() - stream.avail_out;
  }
  inflateEnd(&stream);
  return status == Z_STREAM_END && found == size;
}

}  // namespace fast_edi
