#include "pictures/picture.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <opencv2/imgcodecs.hpp>

namespace fast_edi {
namespace {

constexpr std::array<std::uint8_t, 8> kPngMagic = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kPngWidthOffset = 16;  // behind the length and the name of IHDR
constexpr std::size_t kPngHeaderBytes = kPngWidthOffset + 8;

constexpr std::array<std::uint8_t, 2> kJpegMagic = {0xff, 0xd8};
constexpr std::uint8_t kJpegMarker = 0xff;
constexpr std::uint8_t kJpegFirstFrame = 0xc0;
constexpr std::uint8_t kJpegLastFrame = 0xcf;
constexpr std::size_t kJpegFrameBytes = 9;  // marker, length, precision, height, width

std::uint32_t bigEndian(const std::uint8_t* data, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) {
    value = value << 8 | data[i];
  }
  return value;
}

/// Markers of that range that begin no frame: Huffman tables, an extension, arithmetic coding.
bool isJpegFrame(std::uint8_t marker) {
  return marker >= kJpegFirstFrame && marker <= kJpegLastFrame && marker != 0xc4 &&
         marker != 0xc8 && marker != 0xcc;
}

std::optional<SensorSize> jpegSize(const std::uint8_t* data, std::size_t size) {
  std::size_t at = kJpegMagic.size();
  while (at + kJpegFrameBytes <= size && data[at] == kJpegMarker) {
    const std::uint8_t marker = data[at + 1];
    if (marker == kJpegMarker) {
      ++at;  // filling
    } else if (isJpegFrame(marker)) {
      return SensorSize{static_cast<int>(bigEndian(data + at + 7, 2)),
                        static_cast<int>(bigEndian(data + at + 5, 2))};
    } else {
      at += 2 + bigEndian(data + at + 2, 2);
    }
  }
  return std::nullopt;
}

std::string encodingOf(int type) {
  const bool wide = CV_MAT_DEPTH(type) == CV_16U;
  if (!wide && CV_MAT_DEPTH(type) != CV_8U) {
    return {};
  }
  switch (CV_MAT_CN(type)) {
    case 1:
      return wide ? "mono16" : "mono8";
    case 3:
      return wide ? "bgr16" : "bgr8";
    case 4:
      return wide ? "bgra16" : "bgra8";
    default:
      return {};
  }
}

bool beginsWith(const std::string& text, const char* beginning) {
  return text.rfind(beginning, 0) == 0;
}

/// Exchanges the first and the third channel.
void exchangeRedAndBlue(Picture& picture, std::size_t pixel_bytes, std::size_t sample_bytes) {
  for (std::size_t at = 0; at < picture.pixels.size(); at += pixel_bytes) {
    std::uint8_t* pixel = picture.pixels.data() + at;
    std::swap_ranges(pixel, pixel + sample_bytes, pixel + 2 * sample_bytes);
  }
}

}  // namespace

std::optional<SensorSize> pictureSize(const std::uint8_t* data, std::size_t size) {
  if (size >= kPngHeaderBytes && std::equal(kPngMagic.begin(), kPngMagic.end(), data)) {
    // Sizes beyond 31 bits are no PNG.
    const std::uint32_t width = bigEndian(data + kPngWidthOffset, 4);
    const std::uint32_t height = bigEndian(data + kPngWidthOffset + 4, 4);
    if (width > INT32_MAX || height > INT32_MAX) {
      return std::nullopt;
    }
    return SensorSize{static_cast<int>(width), static_cast<int>(height)};
  }
  if (size >= kJpegMagic.size() && std::equal(kJpegMagic.begin(), kJpegMagic.end(), data)) {
    return jpegSize(data, size);
  }
  return std::nullopt;
}

std::optional<Picture> decodePicture(const std::uint8_t* data, std::size_t size,
                                     std::string& fault) {
  const std::optional<SensorSize> claimed = pictureSize(data, size);
  if (!claimed || claimed->width <= 0 || claimed->height <= 0) {
    fault = "no picture in PNG or JPEG";
    return std::nullopt;
  }
  const std::string claim =
      std::to_string(claimed->width) + "x" + std::to_string(claimed->height) + " pixels";
  if (claimed->pixelCount() > kMaxPicturePixels) {
    fault = "a picture of " + claim + ", expected at most " + std::to_string(kMaxPicturePixels);
    return std::nullopt;
  }
  cv::Mat pixels;
  try {
    // OpenCV only reads, but its matrices cannot be const.
    pixels =
        cv::imdecode(cv::Mat(1, static_cast<int>(size), CV_8UC1, const_cast<std::uint8_t*>(data)),
                     cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    pixels.release();
  }
  Picture picture;
  picture.encoding = pixels.empty() ? std::string() : encodingOf(pixels.type());
  if (picture.encoding.empty()) {
    fault =
        "a picture of " + claim + " that cannot be decoded, expected PNG or JPEG of 8 or 16 bits";
    return std::nullopt;
  }
  picture.size = {pixels.cols, pixels.rows};
  const std::size_t row_bytes = static_cast<std::size_t>(pixels.cols) * pixels.elemSize();
  picture.pixels.resize(row_bytes * static_cast<std::size_t>(pixels.rows));
  for (int y = 0; y < pixels.rows; ++y) {
    std::memcpy(picture.pixels.data() + static_cast<std::size_t>(y) * row_bytes, pixels.ptr(y),
                row_bytes);
  }
  return picture;
}

bool convertPicture(Picture& picture, const std::string& encoding, bool stored_rgb) {
  const bool wide = picture.encoding.find("16") != std::string::npos;
  if (wide != (encoding.find("16") != std::string::npos)) {
    return false;
  }
  const auto channels_of = [](const std::string& name) {
    if (beginsWith(name, "bgra") || beginsWith(name, "rgba")) {
      return std::size_t{4};
    }
    return beginsWith(name, "bgr") || beginsWith(name, "rgb") ? std::size_t{3} : std::size_t{1};
  };
  const std::size_t channels = channels_of(picture.encoding);
  const bool single = beginsWith(encoding, "mono") || beginsWith(encoding, "bayer_") ||
                      encoding == "8UC1" || encoding == "16UC1";
  if (channels != channels_of(encoding) || (channels == 1 && !single)) {
    return false;
  }
  if (channels > 1 && beginsWith(encoding, "rgb") != stored_rgb) {
    const std::size_t sample_bytes = wide ? 2 : 1;
    exchangeRedAndBlue(picture, channels * sample_bytes, sample_bytes);
  }
  picture.encoding = encoding;
  return true;
}

std::string decodeCompressed(const CompressedPicture& compressed, Picture& picture) {
  std::string fault;
  std::optional<Picture> decoded = decodePicture(compressed.data, compressed.bytes, fault);
  if (!decoded) {
    return fault;
  }
  const std::size_t end = compressed.format.find(';');
  if (end != std::string_view::npos) {
    const bool stored_rgb = compressed.format.find("compressed rgb", end) != std::string_view::npos;
    convertPicture(*decoded, std::string(compressed.format.substr(0, end)), stored_rgb);
  }
  picture = std::move(*decoded);
  return {};
}

}  // namespace fast_edi
