/// \file
/// Frames as sensor_msgs/Image has them, without ROS.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fast_edi {

/// Fields of the message.
struct RosImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string_view encoding;
  bool big_endian = false;
  std::uint32_t step = 0;
  const std::uint8_t* data = nullptr;
  std::size_t bytes = 0;
};

/// 0 for encodings that cannot be deblurred; names of sensor_msgs/image_encodings.h.
std::size_t bytesPerPixel(std::string_view encoding);

/// Copies the pixels, little endian and without padding at the ends of rows.
/// \return what is wrong; empty if nothing is
std::string packImage(const RosImage& image, std::vector<std::uint8_t>& pixels);

}  // namespace fast_edi
