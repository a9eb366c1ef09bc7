#include "recording/aedat4_packet_decoder.hpp"

#include <algorithm>

#include "fast_edi/base/number_text.hpp"
#include "recording/aedat4_header.hpp"
#include "recording/aedat4_stamp.hpp"
#include "recording/damage_notes.hpp"
#include "recording/imu_units.hpp"
#include "recording/number_at.hpp"

namespace fast_edi {
namespace {

// Fields of a packet of events, IMU samples or triggers; an event is a struct.
constexpr int kElements = 0;
constexpr std::size_t kEventBytes = 16;
constexpr std::size_t kEventX = 8;
constexpr std::size_t kEventY = 10;
constexpr std::size_t kEventOn = 12;

// Fields of an IMU sample: time, temperature, then both vectors.
constexpr int kSampleTime = 0;
constexpr int kSampleAcceleration = 2;
constexpr int kSampleAngularVelocity = 5;
constexpr int kTriggerTime = 0;
constexpr int kTriggerType = 1;

}  // namespace

void Aedat4PacketDecoder::note(const std::string& what) {
  noteDamage(damage_, {packet_offset_, what});
}

void Aedat4PacketDecoder::open(FlatBytes bytes, std::size_t stream, std::uint64_t offset) {
  table_.reset();
  elements_ = {};
  done_ = 0;
  stream_ = stream;
  packet_offset_ = offset;
  const char* identifier = kAedat4Events;
  switch (streams_[stream].kind) {
    case StreamKind::kFrames:
      identifier = kAedat4Frames;
      break;
    case StreamKind::kImu:
      identifier = kAedat4Imu;
      break;
    case StreamKind::kTriggers:
      identifier = kAedat4Triggers;
      break;
    case StreamKind::kEvents:
    case StreamKind::kCalibration:
      break;
  }
  table_ = FlatTable::root(bytes, identifier);
  if (!table_) {
    note(std::string("expected a packet with the identifier ") + identifier);
    return;
  }
  const bool frame = streams_[stream].kind == StreamKind::kFrames;
  const bool events = streams_[stream].kind == StreamKind::kEvents;
  elements_ = frame ? FlatVector{nullptr, 1, true}
                    : table_->vector(kElements, events ? kEventBytes : sizeof(std::uint32_t));
  if (!elements_.complete) {
    note("a packet that is shorter than it says: " + std::to_string(elements_.count) +
         " elements are there");
  }
}

/// \param t_ns of the item, or of its last element
bool Aedat4PacketDecoder::give(RecordingItem& item, std::int64_t t_ns) {
  item.stream = stream_;
  item.record_ns = advanceClock(t_ns);
  return true;
}

std::int64_t Aedat4PacketDecoder::advanceClock(std::int64_t t_ns) {
  const std::int64_t record_ns = clock_.advance(t_ns);
  if (const std::optional<std::int64_t> ahead_ns = clock_.refutedBy()) {
    constexpr int kDecimals = 1;
    noteDamage(damage_,
               {ahead_offset_, "a time " +
                                   fixedText(static_cast<double>(*ahead_ns) /
                                                 static_cast<double>(kNanosecondsPerSecond),
                                             kDecimals) +
                                   " s ahead of those around it: it does not count"});
  }
  if (clock_.isAhead()) {
    ahead_offset_ = packet_offset_;
  }
  return record_ns;
}

bool Aedat4PacketDecoder::giveEvents(RecordingItem& item) {
  while (table_ && streams_[stream_].kind == StreamKind::kEvents && done_ < elements_.count) {
    if (giveSomeEvents(item)) {
      return true;
    }
  }
  return false;
}

bool Aedat4PacketDecoder::giveSomeEvents(RecordingItem& item) {
  const std::size_t end = std::min(elements_.count, done_ + max_item_events_);
  events_.resize(std::max(events_.size(), end - done_));
  std::size_t count = 0;
  const std::uint8_t* element = elements_.data + done_ * kEventBytes;
  for (std::size_t i = done_; i < end; ++i, element += kEventBytes) {
    const auto t_us = numberAt<std::int64_t>(element);
    // Unsigned: what is no stamp may overflow, and is not kept.
    const std::uint64_t t_ns =
        static_cast<std::uint64_t>(t_us) * static_cast<std::uint64_t>(kNanosecondsPerMicrosecond);
    // Negative coordinates become ones beyond any sensor, which the pipeline drops and counts.
    events_[count] = {numberAt<std::uint16_t>(element + kEventX),
                      numberAt<std::uint16_t>(element + kEventY), static_cast<std::int64_t>(t_ns),
                      element[kEventOn] != 0};
    count += isAedat4Stamp(t_us) ? 1 : 0;  // without a branch; the next event takes its place else
  }
  const std::size_t untold = end - done_ - count;
  done_ = end;
  if (untold > 0) {
    note(std::to_string(untold) + " events with times before 1970 or after 2106");
  }
  if (count == 0) {
    return false;
  }
  item.content = RecordedEvents{events_.data(), count};
  if (count > 1) {
    advanceClock(events_[count - 2].t_ns);  // where the last one is wrong, that is when they came
  }
  return give(item, events_[count - 1].t_ns);
}

bool Aedat4PacketDecoder::giveOther(RecordingItem& item) {
  while (table_ && streams_[stream_].kind != StreamKind::kEvents && done_ < elements_.count) {
    const std::size_t index = done_++;
    const StreamKind kind = streams_[stream_].kind;
    if (kind == StreamKind::kFrames ? giveFrame(item) : giveElement(item, kind, index)) {
      return true;
    }
  }
  return false;
}

bool Aedat4PacketDecoder::giveElement(RecordingItem& item, StreamKind kind, std::size_t index) {
  const std::optional<FlatTable> element = table_->element(kElements, index);
  const std::optional<std::int64_t> t_ns =
      element ? aedat4Stamp(element->number<std::int64_t>(kSampleTime, 0)) : std::nullopt;
  if (!t_ns) {
    note("element " + std::to_string(index) + " of a packet is damaged");
    return false;
  }
  if (kind == StreamKind::kTriggers) {
    static_assert(kTriggerTime == kSampleTime, "both are read above");
    item.content = RecordedTrigger{*t_ns, element->number<std::int8_t>(kTriggerType, 0)};
    return give(item, *t_ns);
  }
  RecordedImu sample;
  sample.t_ns = *t_ns;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    sample.acceleration[i] = kStandardGravity * static_cast<double>(element->number<float>(
                                                    kSampleAcceleration + axis, 0.0F));
    sample.angular_velocity[i] = kRadiansPerDegree * static_cast<double>(element->number<float>(
                                                         kSampleAngularVelocity + axis, 0.0F));
  }
  item.content = sample;
  return give(item, *t_ns);
}

bool Aedat4PacketDecoder::giveFrame(RecordingItem& item) {
  RecordedFrame frame;
  const std::string fault = frame_decoder_.decode(*table_, sensorOf(streams_[stream_]), frame);
  if (!fault.empty()) {
    note("a frame " + fault + ": left out");
    return false;
  }
  item.content = frame;
  return give(item, frame.exposure ? frame.exposure->end_ns : frame.stamp_ns);
}

SensorSize Aedat4PacketDecoder::sensorOf(const RecordedStream& frames) const {
  const auto events = std::find_if(streams_.begin(), streams_.end(), [&](const auto& stream) {
    return stream.kind == StreamKind::kEvents && stream.camera == frames.camera;
  });
  const SensorSize size = events != streams_.end() ? events->size : frames.size;
  return size.width <= kAedat4MaxSide_px && size.height <= kAedat4MaxSide_px ? size : SensorSize{};
}

}  // namespace fast_edi
