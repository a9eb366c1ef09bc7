#include "stream_node/event_output.hpp"

#include <utility>
#include <variant>

#include <ros/advertise_options.h>
#include <boost/make_shared.hpp>

#include "fast_edi/messages/event_array.hpp"
#include "messages/recorded_messages.hpp"

#ifdef FAST_EDI_HAVE_DVS_MSGS
#include <dvs_msgs/EventArray.h>
#endif

namespace fast_edi {
namespace {

/// Arrays that wait for a subscriber in another process: a second, as DV sends them.
constexpr std::uint32_t kArrayQueue = 100;

#ifdef FAST_EDI_HAVE_DVS_MSGS
using PublishedArray = dvs_msgs::EventArray;

void fill(const RecordedEvents& events, PublishedArray& array) {
  array.events.resize(events.count);
  for (std::size_t i = 0; i < events.count; ++i) {
    const Event& event = events.data[i];
    dvs_msgs::Event& out = array.events[i];
    out.x = event.x;
    out.y = event.y;
    out.ts.fromNSec(static_cast<std::uint64_t>(event.t_ns));
    out.polarity = event.on;
  }
}
#else
using PublishedArray = EventArray;

void fill(const RecordedEvents& events, PublishedArray& array) {
  array.append(events.data, events.count);
}
#endif

}  // namespace

EventOutput::EventOutput(ros::NodeHandle nh, std::string frame_id)
    : frame_id_(std::move(frame_id)) {
  ros::AdvertiseOptions options;
  options.init<PublishedArray>("events", kArrayQueue);
  // So that roscpp does not number arrays on the wire itself, without the holes.
  options.has_header = false;
  publisher_ = nh.advertise(options);
}

void EventOutput::begin(const RecordedStream& stream) {
  size_ = stream.size;
  sequence_ += begun_ ? 1 : 0;
  begun_ = true;
}

void EventOutput::add(const RecordingItem& item) {
  const auto* events = std::get_if<RecordedEvents>(&item.content);
  if (events == nullptr || events->count == 0) {
    return;
  }
  const std::uint32_t sequence = sequence_++;
  if (publisher_.getNumSubscribers() == 0) {
    return;
  }
  auto array = boost::make_shared<PublishedArray>();
  array->header.seq = sequence;
  array->header.stamp = stampOf(events->data[0].t_ns);
  array->header.frame_id = frame_id_;
  array->width = static_cast<std::uint32_t>(size_.width);
  array->height = static_cast<std::uint32_t>(size_.height);
  fill(*events, *array);
  publisher_.publish(array);
}

}  // namespace fast_edi
