/// \file
/// Views of image memory that somebody else owns.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast_edi/core/types.hpp"

namespace fast_edi {

/// What one pixel looks like in memory.
enum class PixelFormat {
  kMono8,   ///< one byte
  kBayer8,  ///< one byte, a photosite of a 2 x 2 colour mosaic; its events are its own, too
  kMono16,  ///< two bytes, little endian
  kColor8,  ///< three interleaved bytes (rgb8 or bgr8); all three share the pixel's list
};

inline int channels(PixelFormat format) {
  return format == PixelFormat::kColor8 ? 3 : 1;
}
inline int bytesPerPixel(PixelFormat format) {
  return format == PixelFormat::kMono16 ? 2 : channels(format);
}

/// Read-only image memory; rows are \p step bytes apart.
struct ImageView {
  const std::uint8_t* data = nullptr;
  SensorSize size;
  std::size_t step = 0;
  PixelFormat format = PixelFormat::kMono8;

  const std::uint8_t* row(int y) const { return data + static_cast<std::size_t>(y) * step; }
};

/// Writable image memory; rows are \p step bytes apart.
struct MutableImageView {
  std::uint8_t* data = nullptr;
  SensorSize size;
  std::size_t step = 0;
  PixelFormat format = PixelFormat::kMono8;

  std::uint8_t* row(int y) const { return data + static_cast<std::size_t>(y) * step; }
};

}  // namespace fast_edi
