#include "recording/aedat4_frame_decoder.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "recording/aedat4_stamp.hpp"

namespace fast_edi {
namespace {

// Fields of a frame.
constexpr int kFrameTime = 0;
constexpr int kFrameExposureStart = 3;
constexpr int kFrameExposureEnd = 4;
constexpr int kFrameFormat = 5;
constexpr int kFrameWidth = 6;
constexpr int kFrameHeight = 7;
constexpr int kFrameX = 8;
constexpr int kFrameY = 9;
constexpr int kFramePixels = 10;
constexpr int kFrameExposure = 11;

struct PixelLayout {
  const char* encoding;
  std::size_t bytes;
};

/// Frame formats are OpenCV's types.
std::optional<PixelLayout> layoutOf(int format) {
  switch (format) {
    case 0:
      return PixelLayout{"mono8", 1};
    case 2:
      return PixelLayout{"mono16", 2};
    case 16:
      return PixelLayout{"bgr8", 3};
    case 18:
      return PixelLayout{"bgr16", 6};
    case 24:
      return PixelLayout{"bgra8", 4};
    case 26:
      return PixelLayout{"bgra16", 8};
    default:
      return std::nullopt;
  }
}

/// Exposure start and end; older writers leave one or both away.
std::optional<ExposureInterval> exposureOf(const FlatTable& table) {
  const auto start_us = table.number<std::int64_t>(kFrameExposureStart, 0);
  const auto end_us = table.number<std::int64_t>(kFrameExposureEnd, 0);
  const std::optional<std::int64_t> start = aedat4Stamp(start_us);
  const std::optional<std::int64_t> end = aedat4Stamp(end_us);
  if (start_us > 0 && start && end && *end > *start) {
    return ExposureInterval{*start, *end};
  }
  const std::optional<std::int64_t> begin =
      aedat4Stamp(start_us > 0 ? start_us : table.number<std::int64_t>(kFrameTime, 0));
  const std::optional<std::int64_t> length =
      aedat4Stamp(table.number<std::int64_t>(kFrameExposure, 0));
  if (begin && length && *length > 0 && *length <= kLastStamp_ns - *begin) {
    return ExposureInterval{*begin, *begin + *length};
  }
  return std::nullopt;
}

}  // namespace

SensorSize Aedat4FrameDecoder::sizeOf(const FlatTable& table) {
  return {std::max<int>(0, table.number<std::int16_t>(kFrameWidth, 0)),
          std::max<int>(0, table.number<std::int16_t>(kFrameHeight, 0))};
}

std::string Aedat4FrameDecoder::decode(const FlatTable& table, SensorSize sensor,
                                       RecordedFrame& frame) {
  const int width = table.number<std::int16_t>(kFrameWidth, 0);
  const int height = table.number<std::int16_t>(kFrameHeight, 0);
  const int format = table.number<std::uint8_t>(kFrameFormat, 0);
  const FlatVector pixels = table.vector(kFramePixels, 1);
  const std::optional<PixelLayout> layout = layoutOf(format);
  const std::optional<ExposureInterval> exposure = exposureOf(table);
  const std::optional<std::int64_t> stamp =
      exposure ? exposure->at(ExposureInstant::kMid)
               : aedat4Stamp(table.number<std::int64_t>(kFrameTime, 0));
  if (!layout) {
    return "of format " + std::to_string(format) +
           ", expected 0, 16, 24 (8 bit), 2, 18 or 26 (16 bit)";
  }
  if (!stamp) {
    return "with a time before 1970 or after 2106";
  }
  const std::size_t needed =
      width > 0 && height > 0
          ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * layout->bytes
          : 0;
  if (needed == 0 || pixels.count < needed) {
    return "of " + std::to_string(width) + " x " + std::to_string(height) + " pixels with " +
           std::to_string(pixels.count) + " bytes, expected " + std::to_string(needed);
  }
  frame.exposure = exposure;
  frame.stamp_ns = *stamp;
  frame.size = {width, height};
  frame.encoding = layout->encoding;
  frame.pixels = pixels.data;
  frame.bytes = needed;
  place(frame, sensor, table.number<std::int16_t>(kFrameX, 0),
        table.number<std::int16_t>(kFrameY, 0), layout->bytes);
  return {};
}

void Aedat4FrameDecoder::place(RecordedFrame& frame, SensorSize sensor, int left, int top,
                               std::size_t pixel_bytes) {
  if (frame.size == sensor || left < 0 || top < 0 || frame.size.width > sensor.width - left ||
      frame.size.height > sensor.height - top) {
    return;  // whole, or not within the sensor that the file tells of: as it is
  }
  const std::size_t row_bytes = static_cast<std::size_t>(frame.size.width) * pixel_bytes;
  canvas_.assign(sensor.pixelCount() * pixel_bytes, 0);
  for (int y = 0; y < frame.size.height; ++y) {
    const auto row = static_cast<std::size_t>(y);
    const std::size_t first =
        (row + static_cast<std::size_t>(top)) * static_cast<std::size_t>(sensor.width) +
        static_cast<std::size_t>(left);
    std::memcpy(canvas_.data() + first * pixel_bytes, frame.pixels + row * row_bytes, row_bytes);
  }
  frame.size = sensor;
  frame.pixels = canvas_.data();
  frame.bytes = canvas_.size();
}

}  // namespace fast_edi
