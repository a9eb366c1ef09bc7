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

}  // namespace

PYBIND11_MODULE(_bags, module) {
  pybind11::module::import("fast_edi._fast_edi");  // has the class that open_recording() returns

  module.def("open_recording", &openItems);
}
