#include "python/picture_callback.hpp"

#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>

namespace fast_edi::python {
namespace {

namespace py = pybind11;

/// \throws std::exception when \p decoded is not what is expected
std::string takeDecoded(const py::object& decoded, Picture& picture) {
  if (py::isinstance<py::str>(decoded)) {
    return decoded.cast<std::string>();
  }
  const auto pair = decoded.cast<py::tuple>();
  const auto pixels = py::array::ensure(pair[0], py::array::c_style);
  picture.encoding = pair[1].cast<std::string>();
  picture.size = {static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0))};
  const auto* first = static_cast<const std::uint8_t*>(pixels.data());
  picture.pixels.assign(first, first + pixels.nbytes());
  return {};
}

}  // namespace

PictureDecoder pictureDecoder(py::object decode) {
  const std::shared_ptr<py::object> function(new py::object(std::move(decode)),
                                             [](py::object* held) {
                                               const py::gil_scoped_acquire locked;
                                               delete held;
                                             });
  return [function](const CompressedPicture& compressed, Picture& picture) -> std::string {
    const py::gil_scoped_acquire locked;
    try {
      // Whatever bytes a damaged recording has there, they are a text in this encoding.
      const auto format = py::reinterpret_steal<py::object>(PyUnicode_DecodeLatin1(
          compressed.format.data(), static_cast<py::ssize_t>(compressed.format.size()), nullptr));
      const py::bytes data(reinterpret_cast<const char*>(compressed.data), compressed.bytes);
      return takeDecoded((*function)(format, data), picture);
    } catch (const std::exception& error) {
      return error.what();
    }
  };
}

py::object pictureForPython(const Picture& picture, const std::string& fault) {
  if (!fault.empty()) {
    return py::str(fault);
  }
  const bool wide = picture.encoding.find("16") != std::string::npos;
  const py::dtype type = wide ? py::dtype::of<std::uint16_t>() : py::dtype::of<std::uint8_t>();
  std::vector<py::ssize_t> shape = {picture.size.height, picture.size.width};
  const std::size_t samples = picture.pixels.size() / (picture.size.pixelCount() * (wide ? 2 : 1));
  if (samples > 1) {
    shape.push_back(static_cast<py::ssize_t>(samples));
  }
  return py::make_tuple(py::array(type, shape, picture.pixels.data()), picture.encoding);
}

}  // namespace fast_edi::python
