/// \file
/// The Python module `fast_edi._fast_edi`: what `fast_edi/__init__.py` gives its names and
/// documentation to.

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "fast_edi/config/parameter_error.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "fast_edi/recording/rosbag2_reader.hpp"
#include "python/array_deblurrer.hpp"
#include "python/event_columns.hpp"
#include "python/image_array.hpp"
#include "python/parameter_dict.hpp"
#include "python/picture_callback.hpp"
#include "python/recording_items.hpp"

namespace {

namespace py = pybind11;

using fast_edi::python::ArrayDeblurrer;
using fast_edi::python::RecordingItems;

// pybind11 before 2.12 takes the arrays of NumPy 2 for those of NumPy 1, whose memory is laid out
// otherwise, and reads wrong numbers.
constexpr bool kReadsNumpy2 = PYBIND11_VERSION_MAJOR > 2 ||
                              (PYBIND11_VERSION_MAJOR == 2 && PYBIND11_VERSION_MINOR >= 12);

/// \throws std::runtime_error (ImportError in Python) for a NumPy whose arrays cannot be read
void requireReadableArrays() {
  if (kReadsNumpy2) return;
  const auto version = py::module::import("numpy").attr("__version__").cast<std::string>();
  if (std::stoi(version) >= 2) {
    throw std::runtime_error(
        "fast_edi was built with a pybind11 that reads arrays of NumPy 1 alone, expected NumPy "
        "before 2, found " +
        version + ": install fast_edi in this environment by pip, or numpy<2");
  }
}

void addEvents(ArrayDeblurrer& deblurrer, const py::array& x, const py::array& y,
               const py::array& t, const py::array& p, std::uint32_t lost_arrays) {
  using fast_edi::python::integerColumn;
  const fast_edi::python::EventColumns columns = {integerColumn("x", x), integerColumn("y", y),
                                                  integerColumn("t", t), integerColumn("p", p)};
  const py::gil_scoped_release unlocked;
  deblurrer.addEvents(columns, lost_arrays);
}

void addFrame(ArrayDeblurrer& deblurrer, py::array image, std::int64_t stamp,
              std::optional<std::int64_t> exposure, bool bayer) {
  const auto dimensions = static_cast<int>(image.ndim());
  const fast_edi::ImageView view = fast_edi::python::imageView(image, bayer);
  const py::gil_scoped_release unlocked;
  deblurrer.addFrame(view, dimensions, stamp, exposure);
}

py::tuple toTuple(fast_edi::python::FrameOutput output, std::int64_t unit_ns) {
  const fast_edi::OutputFrame& frame = output.frame;
  py::list latent;
  for (fast_edi::python::LatentOutput& image : output.latent) {
    latent.append(
        py::make_tuple(image.stamp_ns / unit_ns,
                       fast_edi::python::toArray(std::move(image.image), output.dimensions)));
  }
  py::object reason = py::none();
  if (!frame.deblurred) {
    reason = py::str(fast_edi::toString(frame.pass_reason));
  }
  py::object exposure = py::none();
  if (frame.exposure.length() > 0) {
    exposure = py::make_tuple(frame.exposure.start_ns / unit_ns, frame.exposure.end_ns / unit_ns);
  }
  return py::make_tuple(fast_edi::python::toArray(std::move(output.image), output.dimensions),
                        frame.stamp_ns / unit_ns, frame.input.stamp_ns / unit_ns, frame.deblurred,
                        reason, exposure, frame.events, latent);
}

py::list take(ArrayDeblurrer& deblurrer) {
  auto outputs = [&] {
    const py::gil_scoped_release unlocked;
    return deblurrer.take();
  }();
  py::list results;
  for (fast_edi::python::FrameOutput& output : outputs) {
    results.append(toTuple(std::move(output), deblurrer.unit()));
  }
  return results;
}

py::dict counters(ArrayDeblurrer& deblurrer) {
  const fast_edi::DeblurCounters counters = [&] {
    const py::gil_scoped_release unlocked;
    return deblurrer.counters();
  }();
  py::dict passed;
  for (std::size_t reason = 0; reason < fast_edi::kPassReasonCount; ++reason) {
    if (counters.frames_passed[reason] > 0) {
      passed[fast_edi::toString(static_cast<fast_edi::PassReason>(reason))] =
          counters.frames_passed[reason];
    }
  }
  py::dict result;
  result["events_in"] = counters.events_in;
  result["events_late"] = counters.events_late;
  result["events_glitched"] = counters.events_glitched;
  result["events_repeated"] = counters.events_repeated;
  result["events_overflowed"] = counters.events_overflowed;
  result["event_arrays"] = counters.event_arrays;
  result["event_arrays_missing"] = counters.event_arrays_missing;
  result["event_time_jumps"] = counters.event_time_jumps;
  result["frames_in"] = counters.frames_in;
  result["frames_deblurred"] = counters.frames_deblurred;
  result["frames_still"] = counters.frames_still;
  result["frames_timed_out"] = counters.frames_timed_out;
  result["frames_suppressed"] = counters.frames_suppressed;
  result["frames_passed"] = passed;
  result["frame_time_jumps"] = counters.frame_time_jumps;
  result["latent_images"] = counters.latent_images;
  return result;
}

py::dict status(ArrayDeblurrer& deblurrer) {
  const fast_edi::DeblurStatus status = [&] {
    const py::gil_scoped_release unlocked;
    return deblurrer.status();
  }();
  py::dict result;
  result["buffered_events"] = status.buffered_events;
  result["buffer_bytes"] = status.buffer_bytes;
  result["waiting_frames"] = status.waiting_frames;
  result["contrast_threshold_on"] = status.thresholds.on;
  result["contrast_threshold_off"] = status.thresholds.off;
  result["event_delay_us"] =
      static_cast<double>(status.event_delay_ns) / fast_edi::kNanosecondsPerMicrosecond;
  return result;
}

py::list streams(const RecordingItems& items) {
  py::list result;
  for (const fast_edi::RecordedStream& stream : items.recording().streams()) {
    const char* kind = "other";
    if (stream.kind == fast_edi::StreamKind::kEvents) {
      kind = "events";
    } else if (stream.kind == fast_edi::StreamKind::kFrames) {
      kind = "frame";
    } else if (stream.kind == fast_edi::StreamKind::kImu) {
      kind = "imu";
    }
    result.append(
        py::make_tuple(kind, stream.name, stream.camera, stream.size.width, stream.size.height));
  }
  return result;
}

py::object biases(const RecordingItems& items) {
  const auto found = items.recording().biases();
  if (!found) {
    return py::none();
  }
  py::dict result;
  const auto add = [&](const std::string& name, const fast_edi::BiasSetting& bias) {
    result[py::str(name + "_coarse")] = bias.coarse;
    result[py::str(name + "_fine")] = bias.fine;
  };
  add("DiffBn", found->diff);
  add("OnBn", found->on);
  add("OffBn", found->off);
  result["coarse_convention"] = "libcaer";
  return result;
}

py::list damage(RecordingItems& items) {
  const std::vector<fast_edi::RecordingDamage> places = [&] {
    const py::gil_scoped_release unlocked;
    return items.damage();
  }();
  py::list result;
  for (const fast_edi::RecordingDamage& place : places) {
    result.append(py::make_tuple(place.offset, place.what));
  }
  return result;
}

/// Nothing for what the reader of rosbags, or no reader, takes.
/// \param decode see pictureDecoder()
std::unique_ptr<RecordingItems> openItems(const std::string& path, std::int64_t unit_ns,
                                          py::object decode) {
  const fast_edi::PictureDecoder decoder = fast_edi::python::pictureDecoder(std::move(decode));
  const py::gil_scoped_release unlocked;
  std::unique_ptr<fast_edi::Recording> recording =
      fast_edi::formatOf(path) == fast_edi::RecordingFormat::kRosbag2
          ? fast_edi::openRosbag2(path, decoder)
          : fast_edi::openRecording(path);
  return recording ? std::make_unique<RecordingItems>(std::move(recording), unit_ns) : nullptr;
}

}  // namespace

PYBIND11_MODULE(_fast_edi, module) {
  requireReadableArrays();
  module.attr("__version__") = FAST_EDI_VERSION;
  module.attr("_reads_numpy_2") = kReadsNumpy2;
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) {
        std::rethrow_exception(std::move(error));
      }
    } catch (const fast_edi::ParameterError& fault) {
      PyErr_SetString(PyExc_ValueError, fault.what());
    } catch (const fast_edi::RecordingError& fault) {
      PyErr_SetString(PyExc_ValueError, fault.what());
    }
  });

  py::class_<ArrayDeblurrer>(module, "Deblurrer")
      .def(py::init([](int width, int height, std::int64_t unit_ns, int latent_rate_hz,
                       const std::string& config, const py::dict& parameters) {
        fast_edi::DeblurParameters deblur =
            fast_edi::python::loadParameters(config, parameters).deblur;
        deblur.latent.rate_hz = latent_rate_hz;
        return std::make_unique<ArrayDeblurrer>(fast_edi::SensorSize{width, height}, unit_ns,
                                                deblur);
      }))
      .def("add_events", &addEvents)
      .def("add_frame", &addFrame)
      .def("begin_at", &ArrayDeblurrer::beginAt, py::call_guard<py::gil_scoped_release>())
      .def("end_at", &ArrayDeblurrer::endAt, py::call_guard<py::gil_scoped_release>())
      .def("use_recorded_exposures", &ArrayDeblurrer::useRecordedExposures,
           py::call_guard<py::gil_scoped_release>())
      .def("finish", &ArrayDeblurrer::finish, py::call_guard<py::gil_scoped_release>())
      .def("take", &take)
      .def("counters", &counters)
      .def("status", &status);

  py::class_<RecordingItems>(module, "Recording")
      .def("next", &RecordingItems::next)
      .def("format", [](const RecordingItems& items) { return items.recording().format(); })
      .def("streams", &streams)
      .def("biases", &biases)
      .def("knows_exposures",
           [](const RecordingItems& items) { return items.recording().knowsExposures(); })
      .def("damage", &damage);

  module.def("open_recording", &openItems);
  module.def("contrast_from_biases", [](const std::string& path) {
    const fast_edi::ContrastThresholds thresholds = fast_edi::python::contrastFromBiases(path);
    return py::make_tuple(thresholds.on, thresholds.off);
  });
}
