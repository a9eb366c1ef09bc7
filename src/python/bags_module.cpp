/// \file
/// The Python module `fast_edi._bags`: rosbags, whose reader needs ROS, and folders of pictures,
/// whose reader needs OpenCV. Apart from the rest, so that `import fast_edi` loads neither.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>

#include "fast_edi/bags/bag_recording.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/pictures/open_pictures.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "pictures/picture.hpp"
#include "python/picture_callback.hpp"
#include "python/recording_items.hpp"

namespace {

/// Null for anything else.
std::unique_ptr<fast_edi::Recording> openBagOrPictures(const std::string& path) {
  if (fast_edi::formatOf(path) == fast_edi::RecordingFormat::kRosbag) {
    return std::make_unique<fast_edi::BagRecording>(std::vector<std::string>{path},
                                                    fast_edi::TopicNames{});
  }
  return fast_edi::openRecordingOrPictures(path);
}

/// Nothing for what is neither a bag nor a folder of pictures.
std::unique_ptr<fast_edi::python::RecordingItems> openItems(const std::string& path,
                                                            std::int64_t unit_ns) {
  const pybind11::gil_scoped_release unlocked;
  std::unique_ptr<fast_edi::Recording> recording = openBagOrPictures(path);
  if (!recording) {
    return nullptr;
  }
  return std::make_unique<fast_edi::python::RecordingItems>(std::move(recording), unit_ns);
}

/// See pictureDecoder().
pybind11::object decodePicture(const std::string& format, const pybind11::bytes& data) {
  char* bytes = nullptr;
  pybind11::ssize_t size = 0;
  PyBytes_AsStringAndSize(data.ptr(), &bytes, &size);
  fast_edi::Picture picture;
  const std::string fault = [&] {
    const pybind11::gil_scoped_release unlocked;
    return fast_edi::decodeCompressed(
        {format, reinterpret_cast<const std::uint8_t*>(bytes), static_cast<std::size_t>(size)},
        picture);
  }();
  return fast_edi::python::pictureForPython(picture, fault);
}

}  // namespace

PYBIND11_MODULE(_bags, module) {
  pybind11::module::import("fast_edi._fast_edi");  // has the class that open_recording() returns

  module.def("open_recording", &openItems);
  module.def("decode_picture", &decodePicture);
}
