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

EventSubscription::~EventSubscription() {
  ros::Subscriber last;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
    std::swap(last, subscriber_);
  }
  last.shutdown();  // waits, without the mutex that the callback may be waiting for
}

bool EventSubscription::takesPointers() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return takes_pointers_;
}

/// Ends the subscription before. In a callback of that one, this must be the last thing done: the
/// destructor no longer waits for it then.
void EventSubscription::replaceBy(ros::Subscriber next, bool takes_pointers) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!ended_) {
      std::swap(next, subscriber_);
      takes_pointers_ = takes_pointers;
    }
  }
  next.shutdown();
}

void EventSubscription::subscribeToWire() {
  const boost::function<void(const ros::MessageEvent<const EventArray>&)> callback =
      [this](const ros::MessageEvent<const EventArray>& event) { receive(event); };
  replaceBy(nh_.subscribe<EventArray>(topic_, queue_size_, callback, ros::VoidConstPtr(),
                                      ros::TransportHints().tcpNoDelay()),
            false);
}

void EventSubscription::receive(const ros::MessageEvent<const EventArray>& event) {
  const EventArray& array = *event.getConstMessage();
  handler_(array.events(), sensorSize(array), array.header.seq, array.decodingSince());
#ifdef FAST_EDI_HAVE_DVS_MSGS
  if (event.getPublisherName() == ros::this_node::getName()) {
    const std::uint32_t beyond_a_hole = array.header.seq + 2;
    handler_({}, sensorSize(array), beyond_a_hole, 0);
    subscribeToPointers();
  }
#endif
}

#ifdef FAST_EDI_HAVE_DVS_MSGS
void EventSubscription::subscribeToPointers() {
  const boost::function<void(const dvs_msgs::EventArray::ConstPtr&)> callback =
      [this](const dvs_msgs::EventArray::ConstPtr& array) {
        const std::int64_t since_ns = steadyNow();
        handler_(packGeneratedEvents(array->events, records_), sensorSize(*array),
                 array->header.seq, since_ns);
      };
  replaceBy(nh_.subscribe<dvs_msgs::EventArray>(topic_, queue_size_, callback, ros::VoidConstPtr(),
                                                ros::TransportHints().tcpNoDelay()),
            true);
}
#endif

}  // namespace fast_edi
