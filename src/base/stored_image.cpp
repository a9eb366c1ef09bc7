#include "fast_edi/base/stored_image.hpp"

#include <cstring>

namespace fast_edi {

void copyPixels(const ImageView& in, const MutableImageView& out) {
  const std::size_t row_bytes =
      static_cast<std::size_t>(in.size.width) * static_cast<std::size_t>(bytesPerPixel(in.format));
  for (int y = 0; y < in.size.height; ++y) {
    std::memcpy(out.row(y), in.row(y), row_bytes);
  }
}

std::size_t StoredImage::step() const {
  return static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(bytesPerPixel(format_));
}

MutableImageView StoredImage::reshape(SensorSize size, PixelFormat format) {
  size_ = size;
  format_ = format;
  bytes_.resize(step() * static_cast<std::size_t>(size.height));
  return {bytes_.data(), size_, step(), format_};
}

void StoredImage::assign(const ImageView& image) {
  copyPixels(image, reshape(image.size, image.format));
}

ImageView StoredImage::view() const {
  return {bytes_.data(), size_, step(), format_};
}

}  // namespace fast_edi
