/// \file
/// The Python module `fast_edi._bags`: rosbags, whose reader needs ROS. Apart from the rest, so
/// that `import fast_edi` loads no library of ROS.

#include <cstdint>
#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include "fast_edi/bags/bag_recording.hpp"
#include "fast_edi/messages/topic_names.hpp"
#include "python/recording_items.hpp"

PYBIND11_MODULE(_bags, module) {
  namespace py = pybind11;
  py::module::import("fast_edi._fast_edi");  // has the class that open_bag() returns

  module.def("open_bag", [](const std::string& path, std::int64_t unit_ns) {
    const py::gil_scoped_release unlocked;
    return std::make_unique<fast_edi::python::RecordingItems>(
        std::make_unique<fast_edi::BagRecording>(path, fast_edi::TopicNames{}), unit_ns);
  });
}
