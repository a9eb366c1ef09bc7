/// \file
/// Pictures in PNG or JPEG, as recordings hold them. Nothing is decoded whose size is not known to
/// be harmless.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/recording/picture_decoder.hpp"

namespace fast_edi {

/// Larger ones are refused: a small file may claim gigabytes.
constexpr std::size_t kMaxPicturePixels = std::size_t{1} << 24;

/// Width and height by the header of a PNG or JPEG; nothing when it is neither, or cut.
std::optional<SensorSize> pictureSize(const std::uint8_t* data, std::size_t size);

/// \param fault what was found and expected, when there is no picture
/// \return it as mono8, mono16, bgr8, bgr16, bgra8 or bgra16
std::optional<Picture> decodePicture(const std::uint8_t* data, std::size_t size,
                                     std::string& fault);

/// Reorders the channels of \p picture, which decodePicture() gave, to \p encoding, a name of
/// sensor_msgs/image_encodings.h; raw Bayer is kept as it is.
/// \param stored_rgb the channels were stored as red, green, blue
/// \return false when the picture has other channels than \p encoding: it is unchanged
bool convertPicture(Picture& picture, const std::string& encoding, bool stored_rgb);

/// Decodes a picture and gives it the encoding that was compressed, as far as its format tells; one
/// with other channels than that keeps those that it has. A PictureDecoder.
std::string decodeCompressed(const CompressedPicture& compressed, Picture& picture);

}  // namespace fast_edi
