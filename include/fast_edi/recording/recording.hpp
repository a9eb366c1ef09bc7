/// \file
/// One interface for recordings of any format: their streams, and what is in them, item by item.
///
/// A reader trusts no length that its file states. What cannot be read is noted in damage() and
/// left out; reading goes on behind it. Memory does not grow with the length of the recording,
/// except for an index of a few bytes for each packet or message.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/calibration/contrast_from_bias.hpp"

namespace fast_edi {

/// A place that could not be read.
struct RecordingDamage {
  std::uint64_t offset = 0;  ///< byte in the file
  std::string what;
};

enum class StreamKind { kEvents, kFrames, kImu, kTriggers, kCalibration };

struct RecordedStream {
  StreamKind kind = StreamKind::kEvents;
  std::string name;    ///< e.g. "events"; may be empty
  std::string camera;  ///< streams of one camera have the same; may be empty
  SensorSize size;     ///< zero if it was not recorded
};

/// Consecutive events of one sensor, origin top left. Times are within isStamp().
struct RecordedEvents {
  const Event* data = nullptr;
  std::size_t count = 0;
  /// Arrays or packets right before these that the recorder missed, as far as it noticed.
  std::uint32_t lost_arrays = 0;
};

/// A frame; rows without padding.
struct RecordedFrame {
  /// As recorded; nothing where only `stamp_ns` is known.
  std::optional<ExposureInterval> exposure;
  /// Within isStamp(); the middle of the exposure where that is known.
  std::int64_t stamp_ns = 0;
  SensorSize size;
  std::string encoding;  ///< a name of sensor_msgs/image_encodings.h
  const std::uint8_t* pixels = nullptr;
  std::size_t bytes = 0;
};

struct RecordedImu {
  std::int64_t t_ns = 0;
  std::array<double, 3> acceleration = {};      ///< [m/s^2]
  std::array<double, 3> angular_velocity = {};  ///< [rad/s]
};

/// A signal on the camera's connector, or a mark of its own.
struct RecordedTrigger {
  std::int64_t t_ns = 0;
  int type = 0;  ///< as the format numbers them
};

/// Intrinsic calibration, as sensor_msgs/CameraInfo has it; matrices row by row.
struct RecordedCalibration {
  SensorSize size;
  std::string distortion_model;
  std::vector<double> distortion;
  std::array<double, 9> camera_matrix = {};
  std::array<double, 9> rectification = {};
  std::array<double, 12> projection = {};
};

/// More events of one place come in several items: few enough to stay in a core's cache from one
/// stage to the next.
constexpr std::size_t kMaxItemEvents = 10'000;

/// What lies at one place of a recording. Pointers are valid until the next call of next().
struct RecordingItem {
  std::size_t stream = 0;  ///< index into Recording::streams()
  /// When it was recorded, or the latest time in the item; never goes back.
  std::int64_t record_ns = 0;
  std::variant<RecordedEvents, RecordedFrame, RecordedImu, RecordedTrigger, RecordedCalibration>
      content;
};

class Recording {
 public:
  Recording() = default;
  virtual ~Recording() = default;
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// For people, e.g. "AEDAT4, LZ4".
  virtual std::string format() const = 0;
  /// Known from the start.
  virtual const std::vector<RecordedStream>& streams() const = 0;
  /// The next item in the order of record times; false at the end.
  virtual bool next(RecordingItem& item) = 0;
  /// What was found so far; all of it once next() has returned false.
  virtual const std::vector<RecordingDamage>& damage() const = 0;
  /// How far next() has come, in units of the reader's own.
  virtual std::uint64_t position() const = 0;
  /// What position() is at the end.
  virtual std::uint64_t length() const = 0;
  /// Of all files [bytes].
  virtual std::uint64_t fileSize() const = 0;
  /// Frames come with the exposure that the camera measured, wherever it did.
  virtual bool knowsExposures() const { return false; }
  /// Bias settings of the camera, where the recording holds them.
  virtual std::optional<BiasConfiguration> biases() const { return std::nullopt; }
};

}  // namespace fast_edi
