/// \file
/// An image of its own memory, which stays for the next one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/image.hpp"

namespace fast_edi {

/// Copies the pixels. \pre both have the same size and format, and memory
void copyPixels(const ImageView& in, const MutableImageView& out);

class StoredImage {
 public:
  bool empty() const { return bytes_.empty(); }
  /// Discards the image, but keeps its memory.
  void clear() { bytes_.clear(); }

  /// \return room for an image; valid until the next reshape(), assign() or clear()
  MutableImageView reshape(SensorSize size, PixelFormat format);
  /// \param image not empty
  void assign(const ImageView& image);

  /// \pre !empty()
  ImageView view() const;
  std::size_t memoryBytes() const { return bytes_.capacity(); }

 private:
  std::size_t step() const;

  SensorSize size_;
  PixelFormat format_ = PixelFormat::kMono8;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace fast_edi
