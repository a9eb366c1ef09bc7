#include "hdf5/hdf5_frames.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <utility>

#include "fast_edi/base/sensor_size.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "hdf5/hdf5_time.hpp"
#include "recording/damage_notes.hpp"
#include "recording/ros_image.hpp"

namespace fast_edi {
namespace {

constexpr char kImageGroup[] = "images";
constexpr char kStack[] = "davis/left/image_raw";
constexpr char kStackTimes[] = "davis/left/image_raw_ts";
/// Times that a stack may have: frames of a day, at 100 a second.
constexpr hsize_t kMaxStackTimes = 10'000'000;

/// Times of an image as it has them, before their unit is known.
struct ImageTimes {
  std::string name;
  std::optional<Hdf5Number> stamp, start, end;

  std::optional<Hdf5Number> any() const { return start ? start : stamp; }
};

/// Sorts \p frames and \p times alike, by time.
template <typename Frame>
void sortByTime(std::vector<Frame>& frames, std::vector<FrameTime>& times) {
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return times[a].stamp_ns < times[b].stamp_ns;
  });
  std::vector<Frame> sorted_frames;
  std::vector<FrameTime> sorted_times;
  sorted_frames.reserve(order.size());
  sorted_times.reserve(order.size());
  for (const std::size_t i : order) {
    sorted_frames.push_back(std::move(frames[i]));
    sorted_times.push_back(times[i]);
  }
  frames = std::move(sorted_frames);
  times = std::move(sorted_times);
}

std::string unitOf(const Hdf5File& file, const std::string& object) {
  const std::string unit = file.text(object, "unit");
  return unit.empty() ? file.text(object, "units") : unit;
}

}  // namespace

Hdf5Frames::Hdf5Frames(const Hdf5File& file) : file_(file) {
  if (file_.hasGroup(kImageGroup)) {
    findImages();
  } else if (file_.hasDataset(kStack)) {
    findStack();
  }
}

void Hdf5Frames::findImages() {
  std::vector<ImageTimes> images;
  for (const std::string& member : file_.members(kImageGroup)) {
    ImageTimes image;
    image.name = std::string(kImageGroup) + "/" + member;
    if (!file_.hasDataset(image.name)) {
      continue;
    }
    image.stamp = file_.number(image.name, "timestamp");
    image.start = file_.number(image.name, "exposure_start");
    image.end = file_.number(image.name, "exposure_end");
    if (image.any()) {
      images.push_back(std::move(image));
    } else {
      noteDamage(damage_, {0, image.name + " has no attribute timestamp: left out"});
    }
  }
  if (images.empty()) {
    if (!damage_.empty()) {
      throw RecordingError(file_.fault(kImageGroup,
                                       "no image has the attribute timestamp, expected its time, "
                                       "or exposure_start and exposure_end"));
    }
    return;
  }
  const Hdf5Number first = *images.front().any();
  const std::int64_t unit_ns = timeUnit(unitOf(file_, images.front().name), first.is_whole,
                                        first.value, images.back().any()->value);
  const auto time = [unit_ns](const std::optional<Hdf5Number>& number) {
    return number ? timeOf(number->value, unit_ns) : std::nullopt;
  };
  for (ImageTimes& image : images) {
    const std::optional<FrameTime> found =
        frameTimeOf(time(image.stamp), time(image.start), time(image.end));
    if (found) {
      names_.push_back(std::move(image.name));
      times_.push_back(*found);
    } else {
      noteDamage(damage_, {0, image.name + " has no usable time, expected one between 1970 and "
                                           "2106, and an exposure that ends after its start"});
    }
  }
  if (times_.empty()) {
    throw RecordingError(file_.fault(kImageGroup, "no image has a usable time"));
  }
  sortByTime(names_, times_);
}

void Hdf5Frames::findStack() {
  stack_ = std::make_unique<Hdf5Dataset>(file_, kStack);
  if (!file_.hasDataset(kStackTimes)) {
    throw RecordingError(
        file_.fault(kStackTimes, "it is missing, expected the times of " + std::string(kStack)));
  }
  Hdf5Dataset stamps(file_, kStackTimes);
  if (stamps.rowElements() != 1 || stamps.rows() != stack_->rows() ||
      stamps.rows() > kMaxStackTimes) {
    throw RecordingError(file_.fault(kStackTimes, "expected one time for each of " +
                                                      std::to_string(stack_->rows()) + " frames"));
  }
  if (stamps.rows() == 0) {
    return;
  }
  std::vector<double> values(static_cast<std::size_t>(stamps.rows()));
  const std::string fault = stamps.read(0, stamps.rows(), H5T_NATIVE_DOUBLE, values.data());
  if (!fault.empty()) {
    throw RecordingError(file_.fault(kStackTimes, fault));
  }
  const std::int64_t unit_ns =
      timeUnit(unitOf(file_, kStackTimes), !stamps.isFloat(), values.front(), values.back());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::optional<FrameTime> time =
        frameTimeOf(timeOf(values[i], unit_ns), std::nullopt, std::nullopt);
    if (time) {
      stack_rows_.push_back(i);
      times_.push_back(*time);
    } else {
      noteDamage(damage_, {0, std::string(kStackTimes) + ", row " + std::to_string(i) +
                                  ": expected a time between 1970 and 2106"});
    }
  }
  if (times_.empty()) {
    throw RecordingError(file_.fault(kStackTimes, "no frame has a usable time"));
  }
  sortByTime(stack_rows_, times_);
}

std::string Hdf5Frames::name(std::size_t index) const {
  return stack_ ? stack_->name() + ", row " + std::to_string(stack_rows_[index]) : names_[index];
}

std::string Hdf5Frames::read(std::size_t index, RecordedFrame& frame) {
  if (stack_) {
    return readPixels(*stack_, 1, stack_rows_[index], "", frame);
  }
  try {
    Hdf5Dataset image(file_, names_[index]);
    std::string encoding = file_.text(image.name(), "encoding");
    if (encoding.empty() && file_.text(image.name(), "type") == "color_rgb") {
      encoding = "rgb8";
    }
    return readPixels(image, 0, 0, encoding, frame);
  } catch (const RecordingError& error) {
    return error.what();
  }
}

/// \param first_dimension of the pixels: 1 where frames are the rows of the dataset
/// \param encoding as the file names it; may be empty
std::string Hdf5Frames::readPixels(Hdf5Dataset& dataset, std::size_t first_dimension, hsize_t row,
                                   const std::string& encoding, RecordedFrame& frame) {
  const std::vector<hsize_t>& shape = dataset.shape();
  const std::size_t dimensions = shape.size() - first_dimension;
  const hsize_t channels = dimensions == 3 ? shape.back() : 1;
  const std::size_t sample = dataset.elementBytes();
  if (dimensions < 2 || dimensions > 3 || (channels != 1 && channels != 3) || dataset.isFloat() ||
      sample > 2) {
    return "expected pixels of 8 or 16 bits, height x width, or that with 1 or 3 channels";
  }
  const hsize_t height = shape[first_dimension];
  const hsize_t width = shape[first_dimension + 1];
  if (height < 1 || width < 1 || height > static_cast<hsize_t>(kMaxSide_px) ||
      width > static_cast<hsize_t>(kMaxSide_px) || height * width > kMaxPixels) {
    return "a frame of " + sizeText(static_cast<long long>(width), static_cast<long long>(height)) +
           " pixels, expected at most " + std::to_string(kMaxPixels);
  }
  const bool wide = sample == 2;
  pixels_.resize(static_cast<std::size_t>(height * width * channels) * sample);
  std::string fault =
      dataset.read(first_dimension == 0 ? 0 : row, first_dimension == 0 ? height : 1,
                   wide ? H5T_NATIVE_UINT16 : H5T_NATIVE_UINT8, pixels_.data());
  if (!fault.empty()) {
    return fault;
  }
  frame.size = {static_cast<int>(width), static_cast<int>(height)};
  const char* usual = wide ? "mono16" : "mono8";
  if (channels == 3) {
    usual = wide ? "bgr16" : "bgr8";
  }
  frame.encoding = bytesPerPixel(encoding) == sample * channels ? encoding : usual;
  frame.pixels = pixels_.data();
  frame.bytes = pixels_.size();
  return {};
}

}  // namespace fast_edi
