/// \file
/// Views of image memory that somebody else owns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

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

/// A 16-bit digital number for each 8-bit one: 65535 / 255.
constexpr int kDn16PerDn8 = 257;

/// Level of one pixel at \p pixel as an 8-bit digital number; of colours, the mean.
inline std::size_t level8(const std::uint8_t* pixel, PixelFormat format) {
  switch (format) {
    case PixelFormat::kMono16: {
      std::uint16_t level = 0;
      std::memcpy(&level, pixel, sizeof(level));
      return static_cast<std::size_t>(level / kDn16PerDn8);
    }
    case PixelFormat::kColor8:
      return static_cast<std::size_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
    case PixelFormat::kMono8:
    case PixelFormat::kBayer8:
      break;
  }
  return pixel[0];
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
