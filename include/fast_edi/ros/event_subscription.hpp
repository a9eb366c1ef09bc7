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
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <boost/shared_ptr.hpp>

#include "fast_edi/core/event_wire.hpp"
#include "fast_edi/core/types.hpp"
#include "fast_edi/ros/event_array.hpp"

namespace fast_edi {

class EventSubscription {
 public:
  /// \param size of the sensor, {0, 0} when what the array says is impossible
  /// \param decoding_since_ns when decoding of the array began, on the clock of steadyNow(); 0 if
  /// it
  ///        came as a pointer
  using Handler = std::function<void(const WireEvents& events, SensorSize size,
                                     std::uint32_t sequence, std::int64_t decoding_since_ns)>;

  /// \param handler called from \p nh's callback queue
  EventSubscription(const ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                    Handler handler);
  /// Waits for a callback at work to end.
  ~EventSubscription();
  EventSubscription(const EventSubscription&) = delete;
  EventSubscription& operator=(const EventSubscription&) = delete;

  /// True while arrays are taken as pointers to the generated type.
  bool takesPointers() const;

 private:
  void receive(const ros::MessageEvent<const EventArray>& event);
  void subscribeToWire();
  void subscribeToPointers();
  void replaceBy(ros::Subscriber next, bool takes_pointers);

  ros::NodeHandle nh_;
  std::string topic_;
  std::uint32_t queue_size_;
  Handler handler_;
  std::vector<std::uint8_t> records_;  ///< packed events of the array at hand

  /// Guards what is below: a callback may replace the subscription while another thread ends it.
  /// Held only to read or exchange them, never while calling ROS.
  mutable std::mutex mutex_;
  bool ended_ = false;
  bool takes_pointers_ = false;
  ros::Subscriber subscriber_;
};

}  // namespace fast_edi
