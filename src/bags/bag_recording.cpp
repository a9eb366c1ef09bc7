#include "fast_edi/bags/bag_recording.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Int32.h>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

// Streams, in this order.
constexpr std::size_t kEvents = 0;
constexpr std::size_t kFrames = 1;
constexpr std::size_t kImu = 2;

std::string onlyImuTopic(const MessageSource& source) {
  std::set<std::string> topics;
  for (const auto& entry : source.connections()) {
    if (entry.second.md5sum == ros::message_traits::md5sum<sensor_msgs::Imu>()) {
      topics.insert(entry.second.topic);
    }
  }
  return topics.size() == 1 ? *topics.begin() : std::string();
}

}  // namespace

BagRecording::BagRecording(const std::vector<std::string>& paths, const TopicNames& topics)
    : topics_(topics), source_(openMessages(paths)) {
  topics_.output = "/convert_recording";  // none is written
  topics_ = guessTopics(topics_, source_->connections());
  const std::string faults = checkTopics(topics_, source_->connections());
  if (!faults.empty()) {
    throw RecordingError(nameOf(paths) + ": " + faults);
  }
  imu_topic_ = onlyImuTopic(*source_);
  streams_ = {{StreamKind::kEvents, "events", "DAVIS", {}},
              {StreamKind::kFrames, "frames", "DAVIS", {}},
              {StreamKind::kImu, "imu", "DAVIS", {}}};
  findSizes(paths);
}

BagRecording::~BagRecording() = default;

void BagRecording::findSizes(const std::vector<std::string>& paths) {
  const std::unique_ptr<MessageSource> reader = openMessages(paths);
  BagMessage message;
  while ((streams_[kEvents].size.pixelCount() == 0 || streams_[kFrames].size.pixelCount() == 0) &&
         reader->next(message)) {
    try {
      if (message.connection->topic == topics_.events) {
        streams_[kEvents].size = sensorSize(*deserialise<EventArrayView>(message));
      } else if (message.connection->topic == topics_.image) {
        streams_[kFrames].size = readImage(*deserialise<sensor_msgs::Image>(message)).view.size;
      }
    } catch (const ros::serialization::StreamOverrunException&) {
      continue;  // counted when it is read
    }
  }
}

bool BagRecording::next(RecordingItem& item) {
  BagMessage message;
  while (source_->next(message)) {
    record_ns_ = std::max(record_ns_, static_cast<std::int64_t>(message.time.toNSec()));
    try {
      if (take(message, item)) {
        return true;
      }
    } catch (const ros::serialization::StreamOverrunException&) {
      ++malformed_;
    }
  }
  return waiting_ && giveFrame(std::nullopt, item);
}

bool BagRecording::take(const BagMessage& message, RecordingItem& item) {
  const std::string& topic = message.connection->topic;
  item.record_ns = record_ns_;
  if (topic == topics_.events) {
    const auto array = deserialise<EventArrayView>(message);
    if (sequence_gaps_.step(array->header.seq) == SequenceStep::kGap) {
      lost_arrays_ += sequence_gaps_.missing();
    }
    const WireEvents events = array->events();
    events_.resize(events.count);
    for (std::size_t i = 0; i < events.count; ++i) {
      events_[i] = decodeWireEvent(events.record(i));
    }
    item.stream = kEvents;
    if (events_.empty()) {
      return false;
    }
    item.content = RecordedEvents{events_.data(), events_.size(), std::exchange(lost_arrays_, 0)};
    return true;
  }
  if (topic == topics_.image) {
    sensor_msgs::ImagePtr image = deserialise<sensor_msgs::Image>(message);
    if (readImage(*image).verdict != ImageVerdict::kSupported) {
      ++malformed_;
      return false;
    }
    if (!waiting_) {
      waiting_ = std::move(image);
      return false;
    }
    const bool gave = giveFrame(std::nullopt, item);  // its exposure message did not come
    waiting_ = std::move(image);
    return gave;
  }
  if (topic == topics_.exposure) {
    const std::int64_t exposure_us = deserialise<std_msgs::Int32>(message)->data;
    return waiting_ &&
           giveFrame(exposure_us > 0 ? std::optional(exposure_us * kNanosecondsPerMicrosecond)
                                     : std::nullopt,
                     item);
  }
  if (!imu_topic_.empty() && topic == imu_topic_) {
    const auto imu = deserialise<sensor_msgs::Imu>(message);
    const auto& a = imu->linear_acceleration;
    const auto& w = imu->angular_velocity;
    item.stream = kImu;
    item.content = RecordedImu{
        static_cast<std::int64_t>(imu->header.stamp.toNSec()), {a.x, a.y, a.z}, {w.x, w.y, w.z}};
    return true;
  }
  return false;
}

bool BagRecording::giveFrame(std::optional<std::int64_t> exposure_ns, RecordingItem& item) {
  given_ = std::move(waiting_);
  waiting_.reset();
  const ImageReading reading = readImage(*given_);
  const std::size_t row_bytes = static_cast<std::size_t>(reading.view.size.width) *
                                static_cast<std::size_t>(bytesPerPixel(reading.view.format));
  if (reading.view.step != row_bytes) {
    sensor_msgs::ImagePtr packed = makeImageLike(*given_, reading.view.format);
    for (int y = 0; y < reading.view.size.height; ++y) {
      std::copy_n(reading.view.row(y), row_bytes,
                  packed->data.begin() +
                      static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * row_bytes));
    }
    given_ = packed;
  }
  RecordedFrame frame;
  frame.stamp_ns = static_cast<std::int64_t>(given_->header.stamp.toNSec());
  if (exposure_ns) {
    // The driver's rule: see ExposureInterval::at().
    const std::int64_t half_us = *exposure_ns / 2 / kNanosecondsPerMicrosecond;
    const std::int64_t start_ns = frame.stamp_ns - half_us * kNanosecondsPerMicrosecond;
    frame.exposure = ExposureInterval{start_ns, start_ns + *exposure_ns};
  }
  frame.size = reading.view.size;
  frame.encoding = given_->encoding;
  frame.pixels = given_->data.data();
  frame.bytes = row_bytes * static_cast<std::size_t>(frame.size.height);
  item.stream = kFrames;
  item.record_ns = record_ns_;
  item.content = frame;
  return true;
}

}  // namespace fast_edi
