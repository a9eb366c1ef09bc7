/// \file
/// Images in numpy arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <pybind11/numpy.h>

#include "fast_edi/base/image.hpp"

namespace fast_edi::python {

/// A view of an array's own memory, when it can be read in place; else of a copy that \p array is
/// set to.
/// \param array uint8 or uint16, of shape (height, width) or (height, width, 1, 3 or 4)
/// \param bayer a photosite of a colour mosaic in each element
/// \throws pybind11::type_error, std::invalid_argument naming what was found and expected
ImageView imageView(pybind11::array& array, bool bayer);

/// Pixels without padding that become an array without being copied again.
struct PixelBuffer {
  std::unique_ptr<std::uint8_t[]> bytes;
  SensorSize size;
  PixelFormat format = PixelFormat::kMono8;
};

PixelBuffer makeBuffer(SensorSize size, PixelFormat format);
MutableImageView viewOf(PixelBuffer& buffer);

/// \param dimensions 2, or 3 with the samples of a pixel as the last one
pybind11::array toArray(PixelBuffer buffer, int dimensions);

}  // namespace fast_edi::python
