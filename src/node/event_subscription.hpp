/// \file
/// Subscription to event arrays from whoever publishes them.
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
/// Arrays are taken out of roscpp's queue at once, in the thread that received them, and wait for
/// their callback where their memory is bounded, see waiting_arrays.hpp.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <boost/function.hpp>
#include <boost/shared_ptr.hpp>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "node/waiting_arrays.hpp"

namespace fast_edi {

class EventSubscription {
 public:
  /// \param size of the sensor, {0, 0} when what the array says is impossible
  /// \param arrived_ns when the array arrived, on the clock of steadyNow()
  using Handler = std::function<void(const WireEvents& events, SensorSize size,
                                     std::uint32_t sequence, std::int64_t arrived_ns)>;

  /// \param limits of the arrays that wait for their callback; older ones are dropped
  /// \param handler called from \p nh's callback queue
  /// \param on_loss the same, with the number of events that were dropped before the next array
  EventSubscription(const ros::NodeHandle& nh, const std::string& topic,
                    WaitingArrays::Limits limits, Handler handler,
                    WaitingArrays::LossHandler on_loss);
  /// Waits for a callback at work to end.
  ~EventSubscription();
  EventSubscription(const EventSubscription&) = delete;
  EventSubscription& operator=(const EventSubscription&) = delete;

  /// See WaitingArrays.
  void limitWaiting(std::size_t events) { waiting_.limitEvents(events); }

  /// Receives nothing until resume(), if arrays come from another process. What waits is delivered
  /// still, then \p on_suspended is called from the callback queue.
  /// \return false when they come from this one, where nothing has to be received
  bool suspend(std::function<void()> on_suspended);
  /// Receives again. Nothing unless suspended.
  void resume();

  /// True while arrays are taken as pointers to the generated type.
  bool takesPointers() const;

 private:
  /// Calls what is added in the thread that adds it.
  class ImmediateQueue : public ros::CallbackQueueInterface {
   public:
    void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override {
      callback->call();
    }
    void removeByID(std::uint64_t) override {}
  };

  template <typename Array>
  ros::Subscriber subscribe(
      const boost::function<void(const ros::MessageEvent<const Array>&)>& callback);
  void receive(const ros::MessageEvent<const EventArray>& event);
  void handOver(const ros::MessageEvent<const EventArray>& event);
  void subscribeToWire();
  void subscribeToPointers();
  void replaceBy(ros::Subscriber next, bool takes_pointers);

  ros::NodeHandle nh_;
  std::string topic_;
  const std::size_t max_waiting_arrays_;
  Handler handler_;
  ImmediateQueue immediate_queue_;
  WaitingArrays waiting_;
  std::atomic<bool> published_here_{false};  ///< the last array came from this process
  std::vector<std::uint8_t> records_;        ///< packed events of the array at hand

  /// Guards what is below: a callback may replace the subscription while another thread ends it.
  /// Held only to read or exchange them, never while calling ROS.
  mutable std::mutex mutex_;
  bool ended_ = false;
  bool suspended_ = false;
  bool takes_pointers_ = false;
  ros::Subscriber subscriber_;  ///< to be gone before what is above
};

}  // namespace fast_edi
