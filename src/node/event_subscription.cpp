#include "node/event_subscription.hpp"

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include <ros/callback_queue_interface.h>
#include <ros/subscribe_options.h>
#include <ros/this_node.h>
#include <ros/transport_hints.h>
#include <boost/function.hpp>

#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/steady_time.hpp"

#ifdef FAST_EDI_HAVE_DVS_MSGS
#include <dvs_msgs/EventArray.h>

#include "fast_edi/messages/generated_event_array.hpp"
#endif

namespace fast_edi {
namespace {

/// Calls what is added in the thread that adds it.
class ImmediateQueue : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override {
    callback->call();
  }
  void removeByID(std::uint64_t) override {}
};

}  // namespace

struct EventSubscription::State : std::enable_shared_from_this<State> {
  State(ros::CallbackQueueInterface& queue, WaitingArrays::Limits limits, Handler handler_in,
        WaitingArrays::LossHandler on_loss, std::function<void()> on_change_in)
      : handler(std::move(handler_in)),
        on_change(std::move(on_change_in)),
        waiting(queue, limits, std::move(on_loss)) {}

  Source wanted() const;
  void receive(const ros::MessageEvent<const EventArray>& event);
#ifdef FAST_EDI_HAVE_DVS_MSGS
  void receivePointer(const dvs_msgs::EventArray::ConstPtr& array);
  void deliverPointer(const dvs_msgs::EventArray& array, std::int64_t arrived_ns);
#endif
  void announceHole();

  const Handler handler;
  const std::function<void()> on_change;
  ImmediateQueue immediate_queue;
  WaitingArrays waiting;

  /// Guards what is below. Never held while calling the master, on_change or the handler.
  mutable std::mutex mutex;
  bool published_here = false;  ///< by this process
  bool suspended = false;
  WaitingArrays::Delivery on_suspended;
  Source source = Source::kNone;     ///< subscribed to
  SensorSize last_size;              ///< of the last array off the wire
  std::uint32_t last_sequence = 0;   ///< same
  std::vector<std::uint8_t> packed;  ///< memory of the last array that came as a pointer
};

EventSubscription::EventSubscription(const ros::NodeHandle& nh, const std::string& topic,
                                     WaitingArrays::Limits limits, Handler handler,
                                     WaitingArrays::LossHandler on_loss,
                                     std::function<void()> on_change)
    : nh_(nh),
      topic_(nh_.resolveName(topic)),
      max_waiting_arrays_(limits.arrays),
      state_(std::make_shared<State>(*nh_.getCallbackQueue(), limits, std::move(handler),
                                     std::move(on_loss), std::move(on_change))) {
  ros::V_string published_here;
  ros::this_node::getAdvertisedTopics(published_here);
  state_->published_here =
      std::find(published_here.begin(), published_here.end(), topic_) != published_here.end();
}

EventSubscription::~EventSubscription() {
  subscriber_.shutdown();  // waits for an array that is just being received
  state_->waiting.end();   // waits for a delivery at work
}

void EventSubscription::limitWaiting(std::size_t events) {
  state_->waiting.limitEvents(events);
}

bool EventSubscription::suspend(std::function<void()> on_suspended) {
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    if (state_->published_here) {
      return false;
    }
    state_->suspended = true;
    state_->on_suspended = std::move(on_suspended);
  }
  state_->on_change();
  return true;
}

void EventSubscription::resume() {
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->suspended = false;
  }
  state_->on_change();
}

bool EventSubscription::needsUpdate() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->source != state_->wanted();
}

bool EventSubscription::takesPointers() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->source == Source::kPointers;
}

void EventSubscription::update() {
  Source next = Source::kNone;
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    next = state_->wanted();
    if (next == state_->source) {
      return;
    }
  }
  // The new subscription first: while there is one, another one in this process needs no master.
  ros::Subscriber before = std::exchange(subscriber_, subscribeTo(next));
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    const Source last = std::exchange(state_->source, next);
    if (last == Source::kWire && next == Source::kPointers) {
      state_->announceHole();
    }
  }
  before.shutdown();
  if (next == Source::kNone) {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->waiting.add(0, std::move(state_->on_suspended));
  }
}

template <typename Array, typename Callback>
ros::Subscriber EventSubscription::subscribe(Callback callback) {
  using ArrayEvent = ros::MessageEvent<const Array>;
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const ArrayEvent&>(
      topic_, static_cast<std::uint32_t>(max_waiting_arrays_),
      boost::function<void(const ArrayEvent&)>(callback));
  options.callback_queue = &state_->immediate_queue;
  options.allow_concurrent_callbacks = true;  // a publisher's thread must not find it busy
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return nh_.subscribe(options);
}

ros::Subscriber EventSubscription::subscribeTo(Source source) {
  switch (source) {
    case Source::kWire:
      return subscribe<EventArray>(
          [state = state_](const ros::MessageEvent<const EventArray>& event) {
            state->receive(event);
          });
    case Source::kPointers:
#ifdef FAST_EDI_HAVE_DVS_MSGS
      return subscribe<dvs_msgs::EventArray>(
          [state = state_](const ros::MessageEvent<const dvs_msgs::EventArray>& event) {
            state->receivePointer(event.getConstMessage());
          });
#endif
    case Source::kNone:
      break;
  }
  return {};
}

/// \pre mutex is held
EventSubscription::Source EventSubscription::State::wanted() const {
  if (suspended) {
    return Source::kNone;
  }
#ifdef FAST_EDI_HAVE_DVS_MSGS
  if (published_here) {
    return Source::kPointers;
  }
#endif
  return Source::kWire;
}

void EventSubscription::State::receive(const ros::MessageEvent<const EventArray>& event) {
  const EventArray::ConstPtr& array = event.getConstMessage();
  // One that never was on the wire arrives now.
  const std::int64_t arrived_ns =
      array->decodingSince() != 0 ? array->decodingSince() : steadyNow();
  bool changes = false;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (source == Source::kPointers) {
      return;  // behind the hole that was announced
    }
    published_here = event.getPublisherName() == ros::this_node::getName();
    changes = source != wanted();
    last_size = sensorSize(*array);
    last_sequence = array->header.seq;
    waiting.add(array->events().count, [state = shared_from_this(), array, arrived_ns] {
      state->handler(array->events(), sensorSize(*array), array->header.seq, arrived_ns);
    });
  }
  if (changes) {
    on_change();
  }
}

#ifdef FAST_EDI_HAVE_DVS_MSGS
void EventSubscription::State::receivePointer(const dvs_msgs::EventArray::ConstPtr& array) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (source != Source::kPointers) {
    return;  // comes off the wire, too: the subscription is just being replaced
  }
  waiting.add(array->events.size(), [state = shared_from_this(), array, arrived_ns = steadyNow()] {
    state->deliverPointer(*array, arrived_ns);
  });
}

void EventSubscription::State::deliverPointer(const dvs_msgs::EventArray& array,
                                              std::int64_t arrived_ns) {
  // Memory of its own: another thread may be delivering, too.
  std::vector<std::uint8_t> records;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    records.swap(packed);
  }
  handler(packGeneratedEvents(array.events, records), sensorSize(array), array.header.seq,
          arrived_ns);
  const std::lock_guard<std::mutex> lock(mutex);
  records.swap(packed);
}
#endif

/// \pre mutex is held
void EventSubscription::State::announceHole() {
  const std::uint32_t beyond_a_hole = last_sequence + 2;
  waiting.add(0, [state = shared_from_this(), size = last_size, beyond_a_hole] {
    state->handler({}, size, beyond_a_hole, steadyNow());
  });
}

}  // namespace fast_edi
