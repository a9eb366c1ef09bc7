#include "python/image_array.hpp"

#include <new>
#include <stdexcept>
#include <utility>

#include "fast_edi/base/sensor_size.hpp"

namespace fast_edi::python {
namespace {

namespace py = pybind11;

constexpr int kColourSamples = 3;
constexpr int kColourAlphaSamples = 4;

std::string shapeText(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return text + ")";
}

[[noreturn]] void refuseShape(const py::array& array, const std::string& expected) {
  throw std::invalid_argument("image has the shape " + shapeText(array) + ", expected " + expected);
}

PixelFormat formatOf(const py::array& array, bool bayer) {
  const bool wide = array.itemsize() == 2;
  const py::ssize_t samples = array.ndim() == 3 ? array.shape(2) : 1;
  if (bayer && samples != 1) {
    refuseShape(array, "(height, width), because bayer is set");
  }
  switch (samples) {
    case 1:
      if (bayer) {
        return wide ? PixelFormat::kBayer16 : PixelFormat::kBayer8;
      }
      return wide ? PixelFormat::kMono16 : PixelFormat::kMono8;
    case kColourSamples:
      return wide ? PixelFormat::kColour16 : PixelFormat::kColour8;
    case kColourAlphaSamples:
      return wide ? PixelFormat::kColourAlpha16 : PixelFormat::kColourAlpha8;
    default:
      refuseShape(array, "1, 3 or 4 samples for each pixel");
  }
}

/// Pixels beside each other, rows one below the other.
bool readableInPlace(const py::array& array) {
  const bool samples_adjacent =
      array.ndim() == 2 || array.shape(2) == 1 || array.strides(2) == array.itemsize();
  const py::ssize_t pixel_bytes = array.itemsize() * (array.ndim() == 3 ? array.shape(2) : 1);
  return samples_adjacent && array.strides(1) == pixel_bytes &&
         array.strides(0) >= pixel_bytes * array.shape(1);
}

}  // namespace

ImageView imageView(py::array& array, bool bayer) {
  if (array.dtype().kind() != 'u' || array.itemsize() > 2) {
    throw py::type_error("image has dtype " + std::string(py::str(array.dtype())) +
                         ", expected uint8 or uint16");
  }
  if (array.ndim() != 2 && array.ndim() != 3) {
    refuseShape(array, "(height, width) or (height, width, samples)");
  }
  ImageView view;
  view.format = formatOf(array, bayer);
  for (int i = 0; i < 2; ++i) {
    if (array.shape(i) < 1 || array.shape(i) > kMaxSide_px) {
      refuseShape(array, "height and width of 1.." + std::to_string(kMaxSide_px));
    }
  }
  if (!readableInPlace(array)) {
    array = py::array::ensure(array, py::array::c_style);
    if (!array) {
      throw std::bad_alloc();
    }
  }
  view.data = static_cast<const std::uint8_t*>(array.data());
  view.size = {static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0))};
  view.step = static_cast<std::size_t>(array.strides(0));
  return view;
}

PixelBuffer makeBuffer(SensorSize size, PixelFormat format) {
  const std::size_t bytes = size.pixelCount() * static_cast<std::size_t>(bytesPerPixel(format));
  PixelBuffer buffer;
  buffer.bytes.reset(new std::uint8_t[bytes]);  // not set to zero: all of them will be written
  buffer.size = size;
  buffer.format = format;
  return buffer;
}

MutableImageView viewOf(PixelBuffer& buffer) {
  const auto pixel_bytes = static_cast<std::size_t>(bytesPerPixel(buffer.format));
  return {buffer.bytes.get(), buffer.size,
          static_cast<std::size_t>(buffer.size.width) * pixel_bytes, buffer.format};
}

py::array toArray(PixelBuffer buffer, int dimensions) {
  std::vector<py::ssize_t> shape = {buffer.size.height, buffer.size.width};
  if (dimensions == 3) {
    shape.push_back(samplesPerPixel(buffer.format));
  }
  const py::dtype type = bytesPerSample(buffer.format) == 2 ? py::dtype::of<std::uint16_t>()
                                                            : py::dtype::of<std::uint8_t>();
  std::uint8_t* const bytes = buffer.bytes.release();
  const py::capsule owner(bytes, [](void* owned) { delete[] static_cast<std::uint8_t*>(owned); });
  return py::array(type, shape, bytes, owner);
}

}  // namespace fast_edi::python
