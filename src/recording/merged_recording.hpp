/// \file
/// Recordings whose frames and events lie apart, each in the order of their times: merged as a
/// camera would have sent them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// When a frame was taken.
struct FrameTime {
  std::optional<ExposureInterval> exposure;
  std::int64_t stamp_ns = 0;  ///< the middle of the exposure where that is known
};

/// The time and the exposure of a frame, by what a recording says of it; nothing when neither is
/// usable: 0 to 2^32 s, and an exposure that ends after its start.
std::optional<FrameTime> frameTimeOf(std::optional<std::int64_t> stamp_ns,
                                     std::optional<std::int64_t> start_ns,
                                     std::optional<std::int64_t> end_ns);

/// Gives each frame behind the events before the end of its exposure; of one that is not known,
/// before its stamp. Streams are the frames, if there are any, and then the events, if any.
class MergedRecording : public Recording {
 public:
  bool next(RecordingItem& item) final;
  const std::vector<RecordedStream>& streams() const final { return streams_; }
  const std::vector<RecordingDamage>& damage() const final { return damage_; }
  bool knowsExposures() const final;

 protected:
  /// What readEvents() gives.
  struct EventBlock {
    std::vector<Event> events;  ///< empty: no more
    bool lost = false;          ///< events right before these cannot be read
  };

  /// \param times of the frames, in order; empty if there are none
  void addFrames(std::vector<FrameTime> times, SensorSize size);
  /// There are events; readEvents() must work from now on.
  void addEvents(SensorSize size);
  void note(RecordingDamage damage);

  std::size_t frameCount() const { return times_.size(); }
  /// Frames that were given.
  std::size_t framesRead() const { return frame_; }

  /// Sets size, encoding, pixels and bytes.
  /// \return false for a frame that cannot be read, which is noted
  virtual bool readFrame(std::size_t index, RecordedFrame& frame) = 0;
  /// The next events; the vector is empty before.
  virtual void readEvents(EventBlock& block) = 0;

 private:
  bool hasEvents();
  bool giveFrame(RecordingItem& item);
  void giveEvents(RecordingItem& item);

  std::vector<FrameTime> times_;
  std::vector<RecordedStream> streams_;
  std::vector<RecordingDamage> damage_;
  std::size_t frame_ = 0;  ///< the next one
  std::optional<std::size_t> event_stream_;
  EventBlock block_;
  std::size_t event_ = 0;  ///< the next one in the block
  bool events_ended_ = false;
  std::int64_t record_ns_ = 0;
};

}  // namespace fast_edi
