#include "fast_edi/base/image_plane.hpp"

#include <cstring>

#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

/// Truncation rounds to nearest after this is added to a number that is not negative.
constexpr float kHalf = 0.5F;

/// \param stride samples from one pixel to the next
template <typename Level>
void loadRow(const std::uint8_t* in, std::size_t count, std::size_t stride, float* out) {
  for (std::size_t i = 0; i < count; ++i) {
    Level level;
    std::memcpy(&level, in + i * stride * sizeof(Level), sizeof(Level));
    out[i] = static_cast<float>(level);
  }
}

template <typename Level>
void storeRow(const float* in, std::size_t count, std::size_t stride, std::uint8_t* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto level = static_cast<Level>(static_cast<int>(in[i] + kHalf));
    std::memcpy(out + i * stride * sizeof(Level), &level, sizeof(Level));
  }
}

// By far the most frequent case, as vector code.
FAST_EDI_VECTOR_CLONES
void loadBytes(const std::uint8_t* __restrict in, std::size_t count, float* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<float>(static_cast<int>(in[i]));
  }
}

FAST_EDI_VECTOR_CLONES
void storeBytes(const float* __restrict in, std::size_t count, std::uint8_t* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<std::uint8_t>(static_cast<int>(in[i] + kHalf));
  }
}

}  // namespace

void loadPlane(const ImageView& image, int channel, float* plane) {
  const auto width = static_cast<std::size_t>(image.size.width);
  const auto stride = static_cast<std::size_t>(samplesPerPixel(image.format));
  const std::ptrdiff_t bytes = bytesPerSample(image.format);
  for (int y = 0; y < image.size.height; ++y) {
    float* row = plane + static_cast<std::size_t>(y) * width;
    const std::uint8_t* in = image.row(y) + channel * bytes;
    if (bytes == 2) {
      loadRow<std::uint16_t>(in, width, stride, row);
    } else if (stride == 1) {
      loadBytes(in, width, row);
    } else {
      loadRow<std::uint8_t>(in, width, stride, row);
    }
  }
}

void storePlane(const float* plane, int channel, const MutableImageView& image) {
  const auto width = static_cast<std::size_t>(image.size.width);
  const auto stride = static_cast<std::size_t>(samplesPerPixel(image.format));
  const std::ptrdiff_t bytes = bytesPerSample(image.format);
  for (int y = 0; y < image.size.height; ++y) {
    const float* row = plane + static_cast<std::size_t>(y) * width;
    std::uint8_t* out = image.row(y) + channel * bytes;
    if (bytes == 2) {
      storeRow<std::uint16_t>(row, width, stride, out);
    } else if (stride == 1) {
      storeBytes(row, width, out);
    } else {
      storeRow<std::uint8_t>(row, width, stride, out);
    }
  }
}

}  // namespace fast_edi
