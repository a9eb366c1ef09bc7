#include "replay/frame_window.hpp"

#include <algorithm>
#include <utility>

#include <ros/serialization.h>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/message_conversion.hpp"

namespace fast_edi {
namespace {

std::size_t less(std::size_t a, std::size_t b) {
  return a - std::min(a, b);
}

}  // namespace

FrameWindow::FrameWindow(Open open, const TopicNames& topics,
                         std::vector<std::int32_t> exposures_us, Limits limits)
    : open_(std::move(open)),
      topics_(topics),
      exposures_us_(std::move(exposures_us)),
      limits_(limits) {}

bool FrameWindow::moveTo(std::size_t frame) {
  // Where bytes were short, reading again would bring no more.
  const bool is_there = was_limited_
                            ? isInMemory(less(frame, 1), 0)
                            : isInMemory(less(frame, limits_.frames_before), limits_.margin_ns);
  if (!source_ || !is_there) {
    restart();
  }
  frame_ = frame;
  while (!ended_ && !isComplete()) {
    readOne();
  }
  return frame < framesRead();
}

bool FrameWindow::isInMemory(std::size_t frame, std::int64_t margin_ns) const {
  return frame >= framesRead() || discarded_until_ns_ < recordTime(frame) - margin_ns;
}

bool FrameWindow::isComplete() const {
  if (frame_ >= framesRead()) {
    return false;
  }
  return now_ns_ > recordTime(frame_) + limits_.margin_ns || bytes_ > limits_.bytes;
}

void FrameWindow::restart() {
  source_ = open_();
  ended_ = false;
  was_limited_ = false;
  discarded_until_ns_ = kNothing;
  now_ns_ = 0;
  frame_times_ns_.clear();
  items_.clear();
  bytes_ = 0;
}

void FrameWindow::readOne() {
  BagMessage message;
  if (!source_->next(message)) {
    ended_ = true;
    return;
  }
  // A damaged record time must not turn the clock back.
  now_ns_ = std::max(now_ns_, static_cast<std::int64_t>(message.time.toNSec()));
  ReplayItem item;
  item.record_ns = now_ns_;
  item.index = framesRead();
  const std::string& topic = message.connection->topic;
  try {
    if (topic == topics_.events) {
      const auto array = deserialise<EventArrayView>(message);
      const WireEvents events = array->events();
      item.events.assign(events.data, events.data + events.count * kWireEventBytes);
      item.size = sensorSize(*array);
      item.sequence = array->header.seq;
      add(std::move(item));
    } else if (topic == topics_.image) {
      const sensor_msgs::ImageConstPtr image = deserialise<sensor_msgs::Image>(message);
      if (readImage(*image).verdict != ImageVerdict::kMalformed) {
        item.frame = image;
        item.exposure_us = item.index < exposures_us_.size() ? exposures_us_[item.index] : 0;
        frame_times_ns_.push_back(now_ns_);
        add(std::move(item));
      }
    }
  } catch (const ros::serialization::StreamOverrunException&) {
    // Contradicts itself: not used, as in BagPipeline.
  }
}

void FrameWindow::add(ReplayItem item) {
  bytes_ += item.bytes();
  items_.push_back(std::move(item));
  discard();
}

void FrameWindow::discard() {
  const std::size_t kept_from = less(frame_, limits_.frames_before + kStepsBack);
  while (kept_from > 0 && kept_from < framesRead() &&
         items_.front().record_ns < recordTime(kept_from) - limits_.margin_ns) {
    discardFront();
  }
  // Frames that are only passed on the way to the one that is wanted.
  while (kept_from > framesRead() && items_.front().record_ns < now_ns_ - limits_.margin_ns) {
    discardFront();
  }
  while (bytes_ > limits_.bytes && items_.front().index + 1 < std::min(frame_, framesRead())) {
    discardFront();
    was_limited_ = true;
  }
}

void FrameWindow::discardFront() {
  discarded_until_ns_ = items_.front().record_ns;
  bytes_ -= items_.front().bytes();
  items_.pop_front();
}

}  // namespace fast_edi
