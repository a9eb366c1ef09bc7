#include "fast_edi/hdf5/hdf5_writer.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>

#include "fast_edi/recording/recording_error.hpp"
#include "hdf5/hdf5_event_writer.hpp"
#include "hdf5/hdf5_output.hpp"
#include "recording/output_path.hpp"
#include "recording/ros_image.hpp"

namespace fast_edi {
namespace {

double seconds(std::int64_t t_ns) {
  constexpr double kMicrosecondsPerSecond = 1e6;
  const std::int64_t t_us = t_ns / kNanosecondsPerMicrosecond;
  return static_cast<double>(t_us) / kMicrosecondsPerSecond;
}

/// The stream of that kind; null if there is none.
/// \throws RecordingError when there are several
const RecordedStream* onlyStream(const std::vector<RecordedStream>& streams, StreamKind kind,
                                 const std::string& path) {
  const RecordedStream* found = nullptr;
  for (const RecordedStream& stream : streams) {
    if (stream.kind != kind) {
      continue;
    }
    if (found != nullptr) {
      throw RecordingError("cannot write " + path + ": there are several streams of " +
                           (kind == StreamKind::kEvents ? "events" : "frames") +
                           ", expected one, as the layouts of HDF5 have");
    }
    found = &stream;
  }
  return found;
}

}  // namespace

class Hdf5Writer::Impl {
 public:
  Impl(const std::string& path, const std::vector<RecordedStream>& streams,
       Hdf5Compression compression, bool overwrite)
      : path_(path, overwrite), output_(path_.active(), compression) {
    const RecordedStream* events = onlyStream(streams, StreamKind::kEvents, path);
    const RecordedStream* frames = onlyStream(streams, StreamKind::kFrames, path);
    SensorSize size = events != nullptr ? events->size : SensorSize{};
    if (size.pixelCount() == 0 && frames != nullptr) {
      size = frames->size;
    }
    if (size.pixelCount() > 0) {
      output_.setNumbers(output_.file(), "sensor_resolution", {size.height, size.width});
    }
    if (events != nullptr) {
      events_.emplace(output_);
    }
    if (frames != nullptr) {
      images_ = output_.makeGroup("images");
    }
  }

  void write(const RecordingItem& item) {
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      for (std::size_t i = 0; i < events->count; ++i) {
        events_.value().add(events->data[i]);
      }
    } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      writeFrame(*frame);
    }
  }

  void close() {
    if (events_) {
      events_->finish();
    }
    events_.reset();
    images_ = Hdf5Handle();
    output_.close();
    path_.complete();
  }

 private:
  void writeFrame(const RecordedFrame& frame) {
    const bool wide = frame.encoding.find("16") != std::string::npos;
    const std::size_t channels = bytesPerPixel(frame.encoding) / (wide ? 2 : 1);
    if (channels != 1 && channels != 3) {
      throw RecordingError("a frame with the encoding " + frame.encoding +
                           " cannot be written as HDF5, expected one or three channels of 8 or 16 "
                           "bits");
    }
    std::vector<hsize_t> shape = {static_cast<hsize_t>(frame.size.height),
                                  static_cast<hsize_t>(frame.size.width)};
    if (channels == 3) {
      shape.push_back(channels);
    }
    std::array<char, 32> name = {};
    std::snprintf(name.data(), name.size(), "image%09llu",
                  static_cast<unsigned long long>(frames_++));
    const Hdf5Handle image =
        output_.writeArray(images_, name.data(), wide ? H5T_STD_U16LE : H5T_STD_U8LE, shape,
                           wide ? H5T_NATIVE_UINT16 : H5T_NATIVE_UINT8, frame.pixels);
    output_.setNumbers(image, "size", std::vector<std::int64_t>(shape.begin(), shape.end()));
    output_.setNumber(image, "timestamp", seconds(frame.stamp_ns));
    if (frame.exposure) {
      output_.setNumber(image, "exposure_start", seconds(frame.exposure->start_ns));
      output_.setNumber(image, "exposure_end", seconds(frame.exposure->end_ns));
    }
    const char* const colour = frame.encoding.rfind("rgb", 0) == 0 ? "color_rgb" : "color_bgr";
    output_.setText(image, "type", channels == 1 ? "greyscale" : colour);
    output_.setText(image, "encoding", frame.encoding);
  }

  const OutputPath path_;
  Hdf5Output output_;
  std::optional<Hdf5EventWriter> events_;
  Hdf5Handle images_;
  std::uint64_t frames_ = 0;
};

Hdf5Writer::Hdf5Writer(const std::string& path, const std::vector<RecordedStream>& streams,
                       Hdf5Compression compression, bool overwrite)
    : impl_(std::make_unique<Impl>(path, streams, compression, overwrite)) {}
Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::write(const RecordingItem& item) {
  impl_->write(item);
}
void Hdf5Writer::close() {
  impl_->close();
}

}  // namespace fast_edi
