#include "recording/merged_recording.hpp"

#include <algorithm>
#include <limits>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "recording/damage_notes.hpp"

namespace fast_edi {
namespace {

/// An item spans no more.
constexpr std::int64_t kMaxItem_ns = 10 * kNanosecondsPerMillisecond;
constexpr char kCamera[] = "DAVIS";
constexpr std::size_t kFrameStream = 0;

std::int64_t endOf(const FrameTime& time) {
  return time.exposure ? time.exposure->end_ns : time.stamp_ns;
}

}  // namespace

std::optional<FrameTime> frameTimeOf(std::optional<std::int64_t> stamp_ns,
                                     std::optional<std::int64_t> start_ns,
                                     std::optional<std::int64_t> end_ns) {
  const auto is_usable = [](const std::optional<std::int64_t>& t_ns) {
    return t_ns && isStamp(*t_ns);
  };
  FrameTime time;
  if (is_usable(start_ns) && is_usable(end_ns) && *end_ns > *start_ns) {
    time.exposure = ExposureInterval{*start_ns, *end_ns};
    time.stamp_ns = time.exposure->at(ExposureInstant::kMid);
    return time;
  }
  if (!is_usable(stamp_ns)) {
    return std::nullopt;
  }
  time.stamp_ns = *stamp_ns;
  return time;
}

void MergedRecording::addFrames(std::vector<FrameTime> times, SensorSize size) {
  times_ = std::move(times);
  if (!times_.empty()) {
    streams_.push_back({StreamKind::kFrames, "frames", kCamera, size});
  }
}

void MergedRecording::addEvents(SensorSize size) {
  event_stream_ = streams_.size();
  streams_.push_back({StreamKind::kEvents, "events", kCamera, size});
}

void MergedRecording::note(RecordingDamage damage) {
  noteDamage(damage_, std::move(damage));
}

bool MergedRecording::knowsExposures() const {
  return !times_.empty() && std::all_of(times_.begin(), times_.end(), [](const FrameTime& time) {
    return time.exposure.has_value();
  });
}

bool MergedRecording::next(RecordingItem& item) {
  for (;;) {
    const bool events = hasEvents();
    if (frame_ < times_.size() &&
        (!events || block_.events[event_].t_ns >= endOf(times_[frame_]))) {
      if (giveFrame(item)) {
        return true;
      }
    } else if (events) {
      giveEvents(item);
      return true;
    } else {
      return false;
    }
  }
}

bool MergedRecording::hasEvents() {
  if (event_ == block_.events.size() && event_stream_ && !events_ended_) {
    block_.events.clear();
    block_.lost = false;
    event_ = 0;
    readEvents(block_);
    events_ended_ = block_.events.empty();
  }
  return event_ < block_.events.size();
}

bool MergedRecording::giveFrame(RecordingItem& item) {
  const std::size_t index = frame_++;
  RecordedFrame frame;
  frame.exposure = times_[index].exposure;
  frame.stamp_ns = times_[index].stamp_ns;
  if (!readFrame(index, frame)) {
    return false;
  }
  record_ns_ = std::max(record_ns_, endOf(times_[index]));
  item.stream = kFrameStream;
  item.record_ns = record_ns_;
  item.content = frame;
  return true;
}

void MergedRecording::giveEvents(RecordingItem& item) {
  const std::int64_t frame_ns =
      frame_ < times_.size() ? endOf(times_[frame_]) : std::numeric_limits<std::int64_t>::max();
  const std::size_t begin = event_;
  const std::int64_t end_ns = std::min(frame_ns, block_.events[begin].t_ns + kMaxItem_ns);
  const std::size_t last = std::min(block_.events.size(), begin + kMaxItemEvents);
  for (; event_ < last && block_.events[event_].t_ns < end_ns; ++event_) {
    record_ns_ = std::max(record_ns_, block_.events[event_].t_ns);
  }
  RecordedEvents events{block_.events.data() + begin, event_ - begin};
  events.lost_arrays = begin == 0 && block_.lost ? 1 : 0;
  item.stream = *event_stream_;
  item.record_ns = record_ns_;
  item.content = events;
}

}  // namespace fast_edi
