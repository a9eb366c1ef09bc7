/// \file
/// Seeded schedules of messages as a camera's driver might send them, undisturbed or with
/// everything that can go wrong on the way. Free of ROS and of the pipeline: tests deliver them to
/// whatever they test. The same seed gives the same schedule on every platform.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/base/image.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi::testing {

using Random = std::mt19937_64;

/// A number of [lowest, highest]; no std distribution, which differ between platforms.
std::int64_t uniform(Random& random, std::int64_t lowest, std::int64_t highest);
bool chance(Random& random, int percent);

enum class MessageKind { kEvents, kFrame, kExposure };

struct ScheduledMessage {
  MessageKind kind = MessageKind::kEvents;
  std::int64_t now_ns = 0;  ///< arrival on the receiver's clock; increases along a schedule
  SensorSize size;          ///< of event array or frame

  std::vector<std::uint8_t> records;  ///< events: wire records
  std::uint32_t sequence = 0;         ///< events: header.seq

  std::int64_t stamp_ns = 0;  ///< frame
  PixelFormat format = PixelFormat::kMono8;
  bool supported = true;                                    ///< frame: false for odd encodings
  std::shared_ptr<const std::vector<std::uint8_t>> pixels;  ///< frame: rows without padding

  std::int32_t exposure_us = 0;  ///< exposure
};

using Schedule = std::vector<ScheduledMessage>;

/// What a camera records.
struct CameraRun {
  SensorSize size{8, 6};
  PixelFormat format = PixelFormat::kMono8;
  int frames = 8;
  std::int64_t start_ns = 0;          ///< sensor time of the first event
  std::int64_t first_arrival_ns = 0;  ///< receiver's clock at start_ns
  std::uint32_t first_sequence = 1;   ///< of the event arrays
};

/// Frames of 25 Hz with exposures of 1 to 30 ms, each followed by its exposure message, and events
/// meanwhile in arrays of random length. Everything arrives in order, in time and once.
Schedule undisturbedSchedule(Random& random, const CameraRun& run);

/// Up to four runs of a camera whose clock is anywhere in each of them, with messages that are
/// delayed, dropped, repeated, shuffled and odd: stray events and frames of any time, other sensor
/// sizes, exposures of impossible length, sequence numbers that restart.
Schedule disturbedSchedule(Random& random, SensorSize size, PixelFormat format);

/// The frame of a message of that kind; owns its pixels.
InputFrame frameOf(const ScheduledMessage& message);

}  // namespace fast_edi::testing
