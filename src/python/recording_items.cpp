#include "python/recording_items.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <pybind11/numpy.h>

namespace fast_edi::python {
namespace {

namespace py = pybind11;

/// An event as its array has it.
struct EventRecord {
  std::int64_t t = 0;
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  std::uint8_t p = 0;
};

py::dtype eventType() {
  py::list names;
  py::list formats;
  py::list offsets;
  const auto add = [&](const char* name, const char* format, std::size_t offset) {
    names.append(name);
    formats.append(format);
    offsets.append(offset);
  };
  add("x", "<u2", offsetof(EventRecord, x));
  add("y", "<u2", offsetof(EventRecord, y));
  add("t", "<i8", offsetof(EventRecord, t));
  add("p", "u1", offsetof(EventRecord, p));
  return py::dtype(names, formats, offsets, sizeof(EventRecord));
}

py::array eventArray(const RecordedEvents& events, std::int64_t unit_ns) {
  py::array array(eventType(), std::vector<py::ssize_t>{static_cast<py::ssize_t>(events.count)});
  auto* record = static_cast<EventRecord*>(array.mutable_data());
  const py::gil_scoped_release unlocked;
  std::transform(events.data, events.data + events.count, record, [unit_ns](const Event& event) {
    return EventRecord{event.t_ns / unit_ns, event.x, event.y,
                       static_cast<std::uint8_t>(event.on ? 1 : 0)};
  });
  return array;
}

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// Of the encodings of sensor_msgs/image_encodings.h: the shape that the pixels have.
py::tuple frameTuple(const RecordedFrame& frame, std::int64_t unit_ns) {
  const bool wide = frame.encoding.find("16") != std::string::npos;
  std::size_t samples = 1;
  if (startsWith(frame.encoding, "rgba") || startsWith(frame.encoding, "bgra")) {
    samples = 4;
  } else if (startsWith(frame.encoding, "rgb") || startsWith(frame.encoding, "bgr")) {
    samples = 3;
  }
  const py::dtype type = wide ? py::dtype::of<std::uint16_t>() : py::dtype::of<std::uint8_t>();
  std::vector<py::ssize_t> shape = {frame.size.height, frame.size.width};
  if (samples > 1) {
    shape.push_back(static_cast<py::ssize_t>(samples));
  }
  py::object image = py::none();
  if (frame.bytes == frame.size.pixelCount() * samples * (wide ? 2 : 1)) {
    image = py::array(type, shape, frame.pixels);
  }
  py::object exposure = py::none();
  if (frame.exposure) {
    exposure = py::int_(frame.exposure->length() / unit_ns);
  }
  return py::make_tuple(image, frame.stamp_ns / unit_ns, exposure, frame.encoding);
}

py::tuple imuTuple(const RecordedImu& sample, std::int64_t unit_ns) {
  const auto vector = [](const std::array<double, 3>& v) {
    return py::make_tuple(v[0], v[1], v[2]);
  };
  return py::make_tuple(sample.t_ns / unit_ns, vector(sample.acceleration),
                        vector(sample.angular_velocity));
}

}  // namespace

py::object RecordingItems::next() {
  py::gil_scoped_release unlocked;
  const std::lock_guard<std::mutex> turn(mutex_);
  RecordingItem item;
  while (recording_->next(item)) {
    const py::gil_scoped_acquire locked;
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      return py::make_tuple(item.stream, "events",
                            py::make_tuple(eventArray(*events, unit_ns_), events->lost_arrays));
    }
    if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      return py::make_tuple(item.stream, "frame", frameTuple(*frame, unit_ns_));
    }
    if (const auto* sample = std::get_if<RecordedImu>(&item.content)) {
      return py::make_tuple(item.stream, "imu", imuTuple(*sample, unit_ns_));
    }
  }
  const py::gil_scoped_acquire locked;
  return py::none();
}

std::vector<RecordingDamage> RecordingItems::damage() {
  const std::lock_guard<std::mutex> turn(mutex_);
  return recording_->damage();
}

}  // namespace fast_edi::python
