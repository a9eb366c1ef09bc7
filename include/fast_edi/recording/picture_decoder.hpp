/// \file
/// Pictures in PNG or JPEG within recordings: what decodes them is given to the readers, whose
/// library has no decoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

struct Picture {
  SensorSize size;
  std::string encoding;              ///< a name of sensor_msgs/image_encodings.h
  std::vector<std::uint8_t> pixels;  ///< rows without padding
};

/// A picture as sensor_msgs/CompressedImage has it.
struct CompressedPicture {
  std::string_view format;  ///< "jpeg", "png", or "ENCODING; jpeg compressed ORDER"
  const std::uint8_t* data = nullptr;
  std::size_t bytes = 0;
};

/// Decodes into the second argument.
/// \return what is wrong; empty if nothing is
using PictureDecoder = std::function<std::string(const CompressedPicture&, Picture&)>;

}  // namespace fast_edi
