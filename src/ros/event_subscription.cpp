#include "fast_edi/ros/event_subscription.hpp"

#include <algorithm>
#include <utility>

#include <ros/this_node.h>
#include <ros/transport_hints.h>

#include "fast_edi/ros/steady_time.hpp"

#ifdef FAST_EDI_HAVE_DVS_MSGS
#include <dvs_msgs/EventArray.h>

#include "fast_edi/ros/generated_event_array.hpp"
#endif

namespace fast_edi {

EventSubscription::EventSubscription(const ros::NodeHandle& nh, const std::string& topic,
                                     std::uint32_t queue_size, Handler handler)
    : nh_(nh),
      topic_(nh_.resolveName(topic)),
      queue_size_(queue_size),
      handler_(std::move(handler)) {
#ifdef FAST_EDI_HAVE_DVS_MSGS
  ros::V_string published_here;
  ros::this_node::getAdvertisedTopics(published_here);
  if (std::find(published_here.begin(), published_here.end(), topic_) != published_here.end()) {
    subscribeToPointers();
    return;
  }
#endif
  subscribeToWire();
}

void EventSubscription::subscribeToWire() {
  takes_pointers_ = false;
  const boost::function<void(const ros::MessageEvent<const EventArray>&)> callback =
      [this](const ros::MessageEvent<const EventArray>& event) { receive(event); };
  subscriber_ = nh_.subscribe<EventArray>(topic_, queue_size_, callback, ros::VoidConstPtr(),
                                          ros::TransportHints().tcpNoDelay());
}

void EventSubscription::receive(const ros::MessageEvent<const EventArray>& event) {
  const EventArray& array = *event.getConstMessage();
  handler_(array.events(), sensorSize(array), array.header.seq, array.decodingSince());
#ifdef FAST_EDI_HAVE_DVS_MSGS
  if (event.getPublisherName() == ros::this_node::getName()) {
    const SensorSize size = sensorSize(array);
    const std::uint32_t beyond_a_hole = array.header.seq + 2;
    // The array, and with it this subscription's callback, must not be touched any more afterwards.
    subscribeToPointers();
    handler_({}, size, beyond_a_hole, 0);
  }
#endif
}

#ifdef FAST_EDI_HAVE_DVS_MSGS
void EventSubscription::subscribeToPointers() {
  takes_pointers_ = true;
  const boost::function<void(const dvs_msgs::EventArray::ConstPtr&)> callback =
      [this](const dvs_msgs::EventArray::ConstPtr& array) {
        const std::int64_t since_ns = steadyNow();
        handler_(packGeneratedEvents(array->events, records_), sensorSize(*array),
                 array->header.seq, since_ns);
      };
  subscriber_ = nh_.subscribe<dvs_msgs::EventArray>(
      topic_, queue_size_, callback, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
}
#endif

}  // namespace fast_edi
