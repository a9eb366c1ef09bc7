#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/base/sensor_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <boost/make_shared.hpp>

namespace fast_edi {
namespace {

constexpr std::uint32_t kMaxSide = kMaxSide_px;

struct Encoding {
  const char* name;
  PixelFormat format;
};

constexpr std::array<Encoding, 19> kEncodings{{
    {"mono8", PixelFormat::kMono8},          {"8UC1", PixelFormat::kMono8},
    {"mono16", PixelFormat::kMono16},        {"rgb8", PixelFormat::kColour8},
    {"bgr8", PixelFormat::kColour8},         {"rgba8", PixelFormat::kColourAlpha8},
    {"bgra8", PixelFormat::kColourAlpha8},   {"rgb16", PixelFormat::kColour16},
    {"bgr16", PixelFormat::kColour16},       {"rgba16", PixelFormat::kColourAlpha16},
    {"bgra16", PixelFormat::kColourAlpha16}, {"bayer_rggb8", PixelFormat::kBayer8},
    {"bayer_bggr8", PixelFormat::kBayer8},   {"bayer_gbrg8", PixelFormat::kBayer8},
    {"bayer_grbg8", PixelFormat::kBayer8},   {"bayer_rggb16", PixelFormat::kBayer16},
    {"bayer_bggr16", PixelFormat::kBayer16}, {"bayer_gbrg16", PixelFormat::kBayer16},
    {"bayer_grbg16", PixelFormat::kBayer16},
}};

std::optional<PixelFormat> formatOf(const std::string& encoding) {
  const auto* found = std::find_if(kEncodings.begin(), kEncodings.end(),
                                   [&](const Encoding& known) { return encoding == known.name; });
  return found == kEncodings.end() ? std::nullopt : std::optional(found->format);
}

ImageReading refuse(ImageVerdict verdict, std::string reason) {
  ImageReading reading;
  reading.verdict = verdict;
  reading.reason = std::move(reason);
  return reading;
}

std::string sizeText(const sensor_msgs::Image& message) {
  return fast_edi::sizeText(message.width, message.height);
}

}  // namespace

ImageReading readImage(const sensor_msgs::Image& message) {
  if (message.width == 0 || message.height == 0) {
    return refuse(ImageVerdict::kMalformed,
                  "size " + sizeText(message) + ", expected at least 1x1 pixels");
  }
  const std::optional<PixelFormat> format = formatOf(message.encoding);
  if (!format) {
    return refuse(
        ImageVerdict::kUnsupported,
        "encoding \"" + message.encoding +
            "\", expected mono8, 8UC1, mono16, or rgb, bgr, rgba, bgra or bayer_* of 8 or "
            "16 bits");
  }
  if (bytesPerSample(*format) > 1 && message.is_bigendian != 0) {
    return refuse(ImageVerdict::kUnsupported,
                  message.encoding + " in big-endian order, expected little-endian");
  }
  // In 64 bits, where no product of the message's 32-bit fields overflows. The last row may lack
  // its padding.
  const std::uint64_t row_bytes =
      std::uint64_t{message.width} * static_cast<std::uint64_t>(bytesPerPixel(*format));
  if (message.step < row_bytes) {
    return refuse(ImageVerdict::kMalformed, "step " + std::to_string(message.step) +
                                                " bytes, expected at least " +
                                                std::to_string(row_bytes));
  }
  const std::uint64_t needed = std::uint64_t{message.step} * (message.height - 1) + row_bytes;
  if (message.data.size() < needed) {
    return refuse(ImageVerdict::kMalformed, std::to_string(message.data.size()) +
                                                " bytes of data, expected at least " +
                                                std::to_string(needed));
  }
  if (message.width > kMaxSide || message.height > kMaxSide) {
    return refuse(ImageVerdict::kUnsupported, "size " + sizeText(message) + ", expected at most " +
                                                  std::to_string(kMaxSide) + " pixels a side");
  }
  ImageReading reading;
  reading.verdict = ImageVerdict::kSupported;
  reading.view.data = message.data.data();
  reading.view.size = {static_cast<int>(message.width), static_cast<int>(message.height)};
  reading.view.step = message.step;
  reading.view.format = *format;
  return reading;
}

sensor_msgs::ImagePtr makeImageLike(const sensor_msgs::Image& input, PixelFormat format) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = input.header;
  image->height = input.height;
  image->width = input.width;
  image->encoding = input.encoding;
  image->is_bigendian = input.is_bigendian;
  image->step = input.width * static_cast<std::uint32_t>(bytesPerPixel(format));
  image->data.resize(static_cast<std::size_t>(image->step) * image->height);
  return image;
}

MutableImageView viewOf(sensor_msgs::Image& image, PixelFormat format) {
  MutableImageView view;
  view.data = image.data.data();
  view.size = {static_cast<int>(image.width), static_cast<int>(image.height)};
  view.step = image.step;
  view.format = format;
  return view;
}

std::string cameraInfoFault(const sensor_msgs::CameraInfo& info) {
  const auto fault = [](const char* name, const auto& values) -> std::string {
    const bool finite = std::all_of(values.begin(), values.end(),
                                    [](double value) { return std::isfinite(value); });
    return finite ? "" : std::string(name) + " holds a number that is not finite";
  };
  for (const std::string& found :
       {fault("D", info.D), fault("K", info.K), fault("R", info.R), fault("P", info.P)}) {
    if (!found.empty()) {
      return found;
    }
  }
  return {};
}

sensor_msgs::CameraInfoPtr makeCameraInfo(const sensor_msgs::CameraInfo* latest,
                                          const sensor_msgs::Image& image) {
  auto info = latest ? boost::make_shared<sensor_msgs::CameraInfo>(*latest)
                     : boost::make_shared<sensor_msgs::CameraInfo>();
  if (!latest) {
    info->width = image.width;
    info->height = image.height;
  }
  info->header = image.header;
  return info;
}

}  // namespace fast_edi
