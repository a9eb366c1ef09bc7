#include "recording/ros_image.hpp"
#include "fast_edi/base/sensor_size.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace fast_edi {
namespace {

constexpr std::uint32_t kMaxSide = kMaxSide_px;
/// Longest name of an encoding that is worth printing.
constexpr std::size_t kMaxPrinted = 32;

/// Channels by the name without its number of bits.
constexpr std::array<std::pair<std::string_view, std::size_t>, 9> kChannels = {{{"mono", 1},
                                                                                {"rgb", 3},
                                                                                {"bgr", 3},
                                                                                {"rgba", 4},
                                                                                {"bgra", 4},
                                                                                {"bayer_rggb", 1},
                                                                                {"bayer_bggr", 1},
                                                                                {"bayer_gbrg", 1},
                                                                                {"bayer_grbg", 1}}};

std::size_t bytesPerSample(std::string_view encoding) {
  return encoding.size() > 2 && encoding.substr(encoding.size() - 2) == "16" ? 2 : 1;
}

}  // namespace

std::size_t bytesPerPixel(std::string_view encoding) {
  if (encoding == "8UC1") {
    return 1;
  }
  const std::size_t sample = bytesPerSample(encoding);
  if (encoding.empty() || (sample == 1 && encoding.back() != '8')) {
    return 0;
  }
  const std::string_view name = encoding.substr(0, encoding.size() - sample);
  const auto* found = std::find_if(kChannels.begin(), kChannels.end(),
                                   [&](const auto& known) { return known.first == name; });
  return found == kChannels.end() ? 0 : found->second * sample;
}

std::string packImage(const RosImage& image, std::vector<std::uint8_t>& pixels) {
  const std::size_t pixel_bytes = bytesPerPixel(image.encoding);
  if (pixel_bytes == 0) {
    return "a frame in the encoding \"" + std::string(image.encoding.substr(0, kMaxPrinted)) +
           "\", expected mono8, 8UC1, mono16, or rgb, bgr, rgba, bgra or bayer_* of 8 or 16 bits";
  }
  const std::string size = std::to_string(image.width) + " x " + std::to_string(image.height);
  if (image.width == 0 || image.height == 0 || image.width > kMaxSide || image.height > kMaxSide) {
    return "a frame of " + size + " pixels, expected 1 to " + std::to_string(kMaxSide_px) +
           " a side";
  }
  const std::size_t row_bytes = image.width * pixel_bytes;
  // The last row may lack its padding.
  const std::size_t needed = std::size_t{image.step} * (image.height - 1) + row_bytes;
  if (image.step < row_bytes || image.bytes < needed) {
    return "a frame of " + size + " pixels with rows of " + std::to_string(image.step) +
           " bytes and " + std::to_string(image.bytes) + " bytes in all, expected at least " +
           std::to_string(row_bytes) + " and " + std::to_string(row_bytes * image.height);
  }
  pixels.resize(row_bytes * image.height);
  for (std::size_t y = 0; y < image.height; ++y) {
    std::copy_n(image.data + y * image.step, row_bytes,
                pixels.begin() + static_cast<std::ptrdiff_t>(y * row_bytes));
  }
  if (image.big_endian && bytesPerSample(image.encoding) == 2) {
    for (std::size_t i = 0; i + 1 < pixels.size(); i += 2) {
      std::swap(pixels[i], pixels[i + 1]);
    }
  }
  return {};
}

}  // namespace fast_edi
