/// \file
/// One channel of an image as a plane of floats, width x height, row-major.
#pragma once

#include "fast_edi/base/image.hpp"

namespace fast_edi {

/// \param channel 0 to channels(image.format) - 1
/// \param plane image.size.pixelCount() floats, written: levels in the image's own unit [DN]
void loadPlane(const ImageView& image, int channel, float* plane);

/// Rounds to nearest.
/// \param plane levels within the range of the format
void storePlane(const float* plane, int channel, const MutableImageView& image);

}  // namespace fast_edi
