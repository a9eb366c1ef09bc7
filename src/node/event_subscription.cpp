#include "node/event_subscription.hpp"

#include <algorithm>
#include <utility>

#include <ros/subscribe_options.h>
#include <ros/this_node.h>
#include <ros/transport_hints.h>

#include "fast_edi/messages/steady_time.hpp"

#ifdef FAST_EDI_HAVE_DVS_MSGS
#include <dvs_msgs/EventArray.h>

#include "fast_edi/messages/generated_event_array.hpp"
#endif

namespace fast_edi {

EventSubscription::EventSubscription(const ros::NodeHandle& nh, const std::string& topic,
                                     WaitingArrays::Limits limits, Handler handler,
                                     WaitingArrays::LossHandler on_loss)
    : nh_(nh),
      topic_(nh_.resolveName(topic)),
      max_waiting_arrays_(limits.arrays),
      handler_(std::move(handler)),
      waiting_(*nh_.getCallbackQueue(), limits, std::move(on_loss)) {
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
  // Then waiting_ waits for a delivery at work.
}

bool EventSubscription::suspend(std::function<void()> on_suspended) {
  ros::Subscriber last;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (takes_pointers_ || published_here_) {
      return false;
    }
    suspended_ = true;
    std::swap(last, subscriber_);
  }
  last.shutdown();
  waiting_.add(0, std::move(on_suspended));
  return true;
}

void EventSubscription::resume() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    // An array that was still waiting may have told of a publisher in this process.
    if (!std::exchange(suspended_, false) || takes_pointers_) {
      return;
    }
  }
  subscribeToWire();
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

template <typename Array>
ros::Subscriber EventSubscription::subscribe(
    const boost::function<void(const ros::MessageEvent<const Array>&)>& callback) {
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const ros::MessageEvent<const Array>&>(
      topic_, static_cast<std::uint32_t>(max_waiting_arrays_), callback);
  options.callback_queue = &immediate_queue_;
  options.allow_concurrent_callbacks = true;  // a publisher's thread must not find it busy
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return nh_.subscribe(options);
}

void EventSubscription::subscribeToWire() {
  replaceBy(subscribe<EventArray>(
                [this](const ros::MessageEvent<const EventArray>& event) { receive(event); }),
            false);
}

void EventSubscription::receive(const ros::MessageEvent<const EventArray>& event) {
  published_here_ = event.getPublisherName() == ros::this_node::getName();
  waiting_.add(event.getConstMessage()->events().count, [this, event] { handOver(event); });
}

void EventSubscription::handOver(const ros::MessageEvent<const EventArray>& event) {
#ifdef FAST_EDI_HAVE_DVS_MSGS
  if (takesPointers()) {
    return;  // behind the hole that was announced
  }
#endif
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
  replaceBy(subscribe<dvs_msgs::EventArray>(
                [this](const ros::MessageEvent<const dvs_msgs::EventArray>& event) {
                  const dvs_msgs::EventArray::ConstPtr& array = event.getConstMessage();
                  waiting_.add(array->events.size(), [this, array, since_ns = steadyNow()] {
                    handler_(packGeneratedEvents(array->events, records_), sensorSize(*array),
                             array->header.seq, since_ns);
                  });
                }),
            true);
}
#endif

}  // namespace fast_edi
