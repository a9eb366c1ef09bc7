/// \file
/// Views of image memory, without ownership.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// What one pixel looks like in memory. Numbers of 16 bits are little endian.
enum class PixelFormat {
  kMono8,          ///< one byte
  kBayer8,         ///< one byte, a photosite of a 2 x 2 colour mosaic; its events are its own, too
  kMono16,         ///< two bytes
  kColour8,        ///< three interleaved bytes (rgb8 or bgr8); all three share the pixel's list
  kBayer16,        ///< a photosite of two bytes
  kColour16,       ///< three numbers of 16 bits
  kColourAlpha8,   ///< kColour8 and a fourth byte, which passes through unchanged
  kColourAlpha16,  ///< the same of 16 bits
};

constexpr bool isBayer(PixelFormat format) {
  return format == PixelFormat::kBayer8 || format == PixelFormat::kBayer16;
}
constexpr bool hasAlpha(PixelFormat format) {
  return format == PixelFormat::kColourAlpha8 || format == PixelFormat::kColourAlpha16;
}
/// Those that show light: without alpha.
constexpr int channels(PixelFormat format) {
  return format == PixelFormat::kColour8 || format == PixelFormat::kColour16 || hasAlpha(format)
             ? 3
             : 1;
}
constexpr int bytesPerSample(PixelFormat format) {
  return format == PixelFormat::kMono16 || format == PixelFormat::kBayer16 ||
                 format == PixelFormat::kColour16 || format == PixelFormat::kColourAlpha16
             ? 2
             : 1;
}
constexpr int samplesPerPixel(PixelFormat format) {
  return channels(format) + (hasAlpha(format) ? 1 : 0);
}
constexpr int bytesPerPixel(PixelFormat format) {
  return bytesPerSample(format) * samplesPerPixel(format);
}

/// A 16-bit digital number for each 8-bit one: 65535 / 255.
constexpr int kDn16PerDn8 = 257;

/// Digital numbers of the format for each 8-bit one.
constexpr int dnPerDn8(PixelFormat format) {
  return bytesPerSample(format) == 2 ? kDn16PerDn8 : 1;
}

/// Level of one pixel at \p pixel as an 8-bit digital number; of colours, the mean.
inline std::size_t level8(const std::uint8_t* pixel, PixelFormat format) {
  if (bytesPerPixel(format) == 1) {
    return pixel[0];
  }
  const auto count = static_cast<std::size_t>(channels(format));
  std::size_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (bytesPerSample(format) == 2) {
      std::uint16_t level = 0;
      std::memcpy(&level, pixel + i * sizeof(level), sizeof(level));
      sum += level;
    } else {
      sum += pixel[i];
    }
  }
  return sum / count / static_cast<std::size_t>(dnPerDn8(format));
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
