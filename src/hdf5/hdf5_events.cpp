#include "hdf5/hdf5_events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fast_edi/base/sensor_size.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "hdf5/hdf5_time.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kTime = 0;
constexpr std::size_t kX = 1;
constexpr std::size_t kY = 2;
constexpr std::size_t kPolarity = 3;
constexpr std::size_t kColumns = 4;
/// Blocks that are looked at for the size of a sensor that nothing tells.
constexpr std::uint64_t kSampleBlocks = 16;
/// Sensors of event cameras, by their pixels.
constexpr std::array<SensorSize, 5> kKnownSensors = {
    {{128, 128}, {240, 180}, {346, 260}, {640, 480}, {1280, 720}}};

std::string joined(const std::string& group, const char* name) {
  return group == "/" ? std::string(name) : group + "/" + name;
}

}  // namespace

std::optional<Hdf5EventPlace> findEvents(const Hdf5File& file) {
  constexpr std::array<std::array<const char*, kColumns>, 2> kNames = {
      {{"t", "x", "y", "p"}, {"ts", "xs", "ys", "ps"}}};
  for (const char* group : {"events", "/"}) {
    for (const auto& names : kNames) {
      Hdf5EventPlace place;
      place.group = group;
      for (std::size_t c = 0; c < kColumns; ++c) {
        place.columns[c] = joined(group, names[c]);
      }
      if (std::all_of(place.columns.begin(), place.columns.end(),
                      [&](const std::string& name) { return file.hasDataset(name); })) {
        return place;
      }
    }
  }
  // v2e: t, x, y, p; MVSEC: x, y, t, p.
  for (const bool is_mvsec : {false, true}) {
    const char* const name = is_mvsec ? "davis/left/events" : "events";
    if (file.hasDataset(name)) {
      Hdf5EventPlace place;
      place.group = name;
      place.columns.fill(name);
      place.indices = is_mvsec ? std::array<std::size_t, kColumns>{2, 0, 1, 3}
                               : std::array<std::size_t, kColumns>{0, 1, 2, 3};
      place.in_rows = true;
      return place;
    }
  }
  return std::nullopt;
}

Hdf5Events::Hdf5Events(const Hdf5File& file, const Hdf5EventPlace& place, SensorSize frames,
                       std::int64_t frames_last_ns)
    : file_(file), place_(place) {
  if (place_.in_rows) {
    datasets_.emplace_back(file_, place_.columns[0]);
    const std::vector<hsize_t>& shape = datasets_[0].shape();
    if (shape.size() != 2 || shape[1] != kColumns) {
      throw RecordingError(
          file_.fault(place_.columns[0], "expected rows of time, x, y and polarity"));
    }
  } else {
    for (const std::string& name : place_.columns) {
      datasets_.emplace_back(file_, name);
      const Hdf5Dataset& column = datasets_.back();
      if (column.shape().size() != 1 || column.rows() != datasets_[0].rows()) {
        throw RecordingError(file_.fault(name, "expected one column with as many numbers as " +
                                                   datasets_[0].name() + " has, " +
                                                   std::to_string(datasets_[0].rows()) +
                                                   "; found " + std::to_string(column.rows())));
      }
    }
  }
  count_ = datasets_[0].rows();
  has_whole_times_ = !datasets_[kTime].isFloat();
  findUnit(frames_last_ns);
  findOffset();
  findSize(frames);
}

std::string Hdf5Events::readBlock(std::uint64_t first, std::size_t count) {
  if (place_.in_rows) {
    return readRows(first, count);
  }
  block_.whole_times.resize(has_whole_times_ ? count : 0);
  block_.times.resize(has_whole_times_ ? 0 : count);
  std::string fault =
      has_whole_times_
          ? datasets_[kTime].read(first, count, H5T_NATIVE_INT64, block_.whole_times.data())
          : datasets_[kTime].read(first, count, H5T_NATIVE_DOUBLE, block_.times.data());
  std::size_t column = kTime;
  while (fault.empty() && ++column < kColumns) {
    std::vector<std::int32_t>& values = block_.places[column - kX];
    values.resize(count);
    fault = datasets_[column].read(first, count, H5T_NATIVE_INT32, values.data());
  }
  return fault.empty() ? "" : datasets_[column].name() + ": " + fault;
}

std::string Hdf5Events::readRows(std::uint64_t first, std::size_t count) {
  block_.rows.resize(count * kColumns);
  const std::string fault = datasets_[0].read(first, count, H5T_NATIVE_DOUBLE, block_.rows.data());
  if (!fault.empty()) {
    return datasets_[0].name() + ": " + fault;
  }
  block_.whole_times.resize(has_whole_times_ ? count : 0);
  block_.times.resize(has_whole_times_ ? 0 : count);
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  for (std::vector<std::int32_t>& values : block_.places) {
    values.resize(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double* row = block_.rows.data() + i * kColumns;
    const double time = row[place_.indices[kTime]];
    if (has_whole_times_) {
      // Beyond the numbers that doubles hold there are no stamps.
      block_.whole_times[i] = std::abs(time) <= static_cast<double>(kLastStamp_ns)
                                  ? static_cast<std::int64_t>(time)
                                  : std::int64_t{-1};
    } else {
      block_.times[i] = time;
    }
    for (std::size_t c = kX; c < kColumns; ++c) {
      const double value = row[place_.indices[c]];
      block_.places[c - kX][i] =
          std::abs(value) <= kMost ? static_cast<std::int32_t>(value) : std::int32_t{-1};
    }
  }
  return {};
}

void Hdf5Events::findUnit(std::int64_t frames_last_ns) {
  if (count_ == 0) {
    return;
  }
  const auto time_of = [this](std::uint64_t index) {
    const std::string fault = readBlock(index, 1);
    if (!fault.empty()) {
      return 0.0;  // noted when it comes
    }
    return has_whole_times_ ? static_cast<double>(block_.whole_times[0]) : block_.times[0];
  };
  const double first = time_of(0);
  const double last = time_of(count_ - 1);
  std::string said = file_.text(place_.columns[kTime], "unit");
  if (said.empty()) {
    said = file_.text(place_.columns[kTime], "units");
  }
  unit_ns_ = timeUnit(said, has_whole_times_, first, last);
  // Whole numbers from 0 may be nanoseconds: frames tell how long they last.
  if (said.empty() && has_whole_times_ && frames_last_ns > 0 && last > first) {
    const double ratio = (last - first) / static_cast<double>(frames_last_ns);
    if (std::abs(std::log(ratio)) <
        std::abs(std::log(ratio * static_cast<double>(kNanosecondsPerMicrosecond)))) {
      unit_ns_ = 1;
    }
  }
}

void Hdf5Events::findOffset() {
  for (const std::string& name : {std::string("t_offset"), joined(place_.group, "t_offset")}) {
    if (place_.in_rows || !file_.hasDataset(name)) {
      continue;
    }
    Hdf5Dataset offset(file_, name);
    std::int64_t value = 0;
    if (offset.rows() != 1 || offset.rowElements() != 1) {
      throw RecordingError(file_.fault(name, "expected one number"));
    }
    const std::string fault = offset.read(0, 1, H5T_NATIVE_INT64, &value);
    const std::optional<std::int64_t> offset_ns =
        fault.empty() ? timeOf(value, unit_ns_) : std::nullopt;
    if (!offset_ns) {
      throw RecordingError(file_.fault(
          name, fault.empty()
                    ? "a time of " + std::to_string(value) + ", expected one between 1970 and 2106"
                    : fault));
    }
    offset_ns_ = *offset_ns;
    return;
  }
}

void Hdf5Events::findSize(SensorSize frames) {
  size_ = frames.pixelCount() > 0 ? frames : statedSize();
  if (size_.pixelCount() == 0) {
    size_ = sizeOfSamples();
  }
}

SensorSize Hdf5Events::statedSize() const {
  const auto size_of = [](std::int64_t width, std::int64_t height) {
    const bool possible = width > 0 && height > 0 && width <= kMaxSide_px && height <= kMaxSide_px;
    return possible ? SensorSize{static_cast<int>(width), static_cast<int>(height)} : SensorSize{};
  };
  const std::vector<std::int64_t> resolution = file_.wholeNumbers("/", "sensor_resolution");
  if (resolution.size() >= 2) {
    return size_of(resolution[1], resolution[0]);
  }
  for (const std::string& object : {place_.group, std::string("/")}) {
    const std::vector<std::int64_t> width = file_.wholeNumbers(object, "width");
    const std::vector<std::int64_t> height = file_.wholeNumbers(object, "height");
    if (width.size() == 1 && height.size() == 1) {
      return size_of(width[0], height[0]);
    }
  }
  return {};
}

SensorSize Hdf5Events::sizeOfSamples() {
  std::int32_t x = 0;
  std::int32_t y = 0;
  const std::uint64_t step = std::max<std::uint64_t>(count_ / kSampleBlocks, kBlockEvents);
  for (std::uint64_t first = 0; first < count_; first += step) {
    const auto block =
        static_cast<std::size_t>(std::min<std::uint64_t>(count_ - first, kBlockEvents));
    if (!readBlock(first, block).empty()) {
      continue;
    }
    for (std::size_t i = 0; i < block; ++i) {
      x = std::max(x, block_.places[0][i]);
      y = std::max(y, block_.places[1][i]);
    }
  }
  for (const SensorSize& sensor : kKnownSensors) {
    if (x < sensor.width && y < sensor.height) {
      return sensor;
    }
  }
  return {std::min(x, kMaxSide_px - 1) + 1, std::min(y, kMaxSide_px - 1) + 1};
}

std::optional<std::int64_t> Hdf5Events::timeAt(std::size_t i) const {
  if (!has_whole_times_) {
    const std::optional<std::int64_t> t_ns = timeOf(block_.times[i], unit_ns_);
    return t_ns && isStamp(*t_ns + offset_ns_) ? std::optional(*t_ns + offset_ns_) : std::nullopt;
  }
  const std::int64_t time = block_.whole_times[i];
  const std::int64_t most = kLastStamp_ns / unit_ns_;
  if (time < -most || time > most) {
    return std::nullopt;
  }
  const std::int64_t t_ns = time * unit_ns_ + offset_ns_;
  return isStamp(t_ns) ? std::optional(t_ns) : std::nullopt;
}

bool Hdf5Events::read(std::vector<Event>& events, std::string& fault) {
  fault.clear();
  has_lost_ = false;
  if (next_ == count_) {
    return false;
  }
  const std::uint64_t first = next_;
  const auto count =
      static_cast<std::size_t>(std::min<std::uint64_t>(count_ - first, kBlockEvents));
  next_ += count;
  const std::string unreadable = readBlock(first, count);
  if (!unreadable.empty()) {
    has_lost_ = true;
    fault = "events " + std::to_string(first) + " to " + std::to_string(first + count - 1) +
            " cannot be read, of " + unreadable;
    return true;
  }
  std::size_t untold = 0;
  std::size_t outside = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t x = block_.places[kX - kX][i];
    const std::int32_t y = block_.places[kY - kX][i];
    const std::optional<std::int64_t> t_ns = timeAt(i);
    if (!t_ns) {
      ++untold;
    } else if (x < 0 || y < 0 || x >= size_.width || y >= size_.height) {
      ++outside;
    } else {
      events.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), *t_ns,
                        block_.places[kPolarity - kX][i] > 0});
    }
  }
  if (untold + outside > 0) {
    fault = "among events " + std::to_string(first) + " to " + std::to_string(first + count - 1) +
            ", " + std::to_string(untold) + " have a time before 1970 or after 2106 and " +
            std::to_string(outside) + " lie outside of the " + sizeText(size_.width, size_.height) +
            " pixels";
  }
  return true;
}

}  // namespace fast_edi
