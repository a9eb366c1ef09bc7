/// \file
/// Subscription to event arrays, from this process or another one.
///
/// From another process an array comes as bytes, which EventArray keeps as they are. From a
/// publisher in the same process (the driver in the same nodelet manager) it comes as a pointer,
/// without having been serialised, when this package was built with the `dvs_msgs` package
/// (FAST_EDI_HAVE_DVS_MSGS); else roscpp serialises it for us.
///
/// roscpp hands a pointer over only to a subscriber of the very C++ type that was published, and a
/// subscriber of the generated type receives bytes by the slow generated code. So the type is
/// chosen by where the publisher is: the generated one from the moment that this process publishes
/// the topic. A publisher that starts later is noticed by its first array; arrays that get lost
/// while the subscription is replaced are announced as a hole in the sequence.
///
/// What is to be received may change at any time and in any thread. update() alone does what that
/// takes, since roscpp's subscribe() calls the master, and while there is none does not return.
///
/// Arrays are taken out of roscpp's queue at once, in the thread that received them, and wait for
/// their callback where their memory is bounded, see waiting_arrays.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "node/waiting_arrays.hpp"

namespace fast_edi {

class EventSubscription {
 public:
  /// \param size of the sensor, {0, 0} when what the array says is impossible
  /// \param arrived_ns when the array arrived, on the clock of steadyNow(); for a hole that is
  ///        announced, when it is
  using Handler = std::function<void(const WireEvents& events, SensorSize size,
                                     std::uint32_t sequence, std::int64_t arrived_ns)>;

  /// \param limits of the arrays that wait for their callback; older ones are dropped
  /// \param handler called from \p nh's callback queue
  /// \param on_loss the same, with the number of events that were dropped before the next array
  /// \param on_change called when there is something to do for update(), from any thread, with no
  ///        lock held
  EventSubscription(const ros::NodeHandle& nh, const std::string& topic,
                    WaitingArrays::Limits limits, Handler handler,
                    WaitingArrays::LossHandler on_loss, std::function<void()> on_change);
  /// Waits for a callback at work to end: not to be called from one, nor with a lock held that one
  /// may want.
  ~EventSubscription();
  EventSubscription(const EventSubscription&) = delete;
  EventSubscription& operator=(const EventSubscription&) = delete;

  /// See WaitingArrays.
  void limitWaiting(std::size_t events);

  /// Nothing is to be received until resume(), if arrays come from another process. What waits then
  /// is delivered still, and \p on_suspended is called from the callback queue after it.
  /// \return false when they come from this one, where nothing has to be received
  bool suspend(std::function<void()> on_suspended);
  /// Arrays are to be received again.
  void resume();

  /// True when there is something to do for update().
  bool needsUpdate() const;
  /// Subscribes or unsubscribes, so that what is to be received is. Nothing is received before the
  /// first call. Calls the master, and waits for it: not to be called with a lock held that a
  /// callback may want. One call at a time, none while this object is destroyed.
  void update();

  /// True while arrays are taken as pointers to the generated type.
  bool takesPointers() const;

 private:
  enum class Source { kNone, kWire, kPointers };
  struct State;

  template <typename Array, typename Callback>
  ros::Subscriber subscribe(Callback callback);
  ros::Subscriber subscribeTo(Source source);

  ros::NodeHandle nh_;
  const std::string topic_;
  const std::size_t max_waiting_arrays_;
  /// Shared with roscpp's callbacks and with deliveries, so that it outlives all of them.
  const std::shared_ptr<State> state_;
  ros::Subscriber subscriber_;  ///< of update() alone
};

}  // namespace fast_edi
