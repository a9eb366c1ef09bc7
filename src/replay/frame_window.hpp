/// \file
/// A frame of a recording with what lies around it, in memory, as long as the recording may be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include <sensor_msgs/Image.h>

#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// An event array or a frame, as it was recorded.
struct ReplayItem {
  std::int64_t record_ns = 0;
  std::vector<std::uint8_t> events;  ///< wire records
  SensorSize size;                   ///< of the sensor, as the array states it
  std::uint32_t sequence = 0;        ///< of the array
  sensor_msgs::ImageConstPtr frame;  ///< null for an array
  std::size_t index = 0;             ///< of the frame, from 0 on; of an array: of the next frame
  std::int32_t exposure_us = 0;      ///< of the frame; 0: none of its own

  std::size_t bytes() const { return events.size() + (frame ? frame->data.size() : 0); }
};

/// Moves forward by reading on; back by a few frames within what is in memory, else by reading from
/// the start again.
///
/// Memory: of Limits::bytes, more only where the frame and the one before it need it; besides, 12
/// bytes for each frame of the recording.
class FrameWindow {
 public:
  /// Steps back that need no reading.
  static constexpr std::size_t kStepsBack = 16;

  struct Limits {
    std::size_t frames_before = 1;  ///< kept before the frame
    /// Of event arrays before all these and behind the frame, by times of recording.
    std::int64_t margin_ns = 0;
    std::size_t bytes = std::size_t{1} << 29;
  };
  /// Opens the recording at its start.
  using Open = std::function<std::unique_ptr<MessageSource>()>;

  /// \param exposures_us of the frames, in order; 0: none of its own
  FrameWindow(Open open, const TopicNames& topics, std::vector<std::int32_t> exposures_us,
              Limits limits);

  /// \return false when the recording has no such frame
  /// \throws RecordingError when it cannot be opened
  bool moveTo(std::size_t frame);

  std::size_t frame() const { return frame_; }
  /// In the order of their record times, which never fall.
  const std::deque<ReplayItem>& items() const { return items_; }
  /// Time of recording of a frame that was read.
  std::int64_t recordTime(std::size_t frame) const { return frame_times_ns_[frame]; }
  std::int64_t margin() const { return limits_.margin_ns; }
  std::size_t bytes() const { return bytes_; }

 private:
  static constexpr std::int64_t kNothing = std::numeric_limits<std::int64_t>::min();

  std::size_t framesRead() const { return frame_times_ns_.size(); }
  bool isInMemory(std::size_t frame, std::int64_t margin_ns) const;
  bool isComplete() const;
  void restart();
  void readOne();
  void add(ReplayItem item);
  void discard();
  void discardFront();

  const Open open_;
  const TopicNames topics_;
  const std::vector<std::int32_t> exposures_us_;
  const Limits limits_;
  std::unique_ptr<MessageSource> source_;
  bool ended_ = false;
  bool was_limited_ = false;                    ///< frames before were discarded for want of bytes
  std::int64_t discarded_until_ns_ = kNothing;  ///< by times of recording
  std::size_t frame_ = 0;
  std::int64_t now_ns_ = 0;
  std::vector<std::int64_t> frame_times_ns_;  ///< of those that were read since the start
  std::deque<ReplayItem> items_;
  std::size_t bytes_ = 0;
};

}  // namespace fast_edi
