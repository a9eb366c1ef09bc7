/// \file
/// What a deblurring node receives while its outputs are wanted: the input subscriptions and the
/// clock, which come and go together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include <dynamic_reconfigure/Config.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>
#include <boost/function.hpp>

#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/events/sequence_gaps.hpp"
#include "node/event_subscription.hpp"
#include "node/overload_guard.hpp"
#include "node/periodic_callback.hpp"
#include "node/repeated_messages.hpp"

namespace fast_edi {

/// The destructor waits for callbacks at work: the caller must hold no lock that one may want.
class NodeInputs {
 public:
  /// Called from the callback queue of the node handle, except on_change.
  struct Handlers {
    EventSubscription::Handler events;
    WaitingArrays::LossHandler lost_events;
    /// No events are received until they are resumed: see OverloadGuard.
    std::function<void()> events_suspended;
    std::function<void(const sensor_msgs::ImageConstPtr&)> image;
    std::function<void(const sensor_msgs::CameraInfoConstPtr&)> camera_info;
    std::function<void(const std_msgs::Int32ConstPtr&)> exposure;
    std::function<void(const dynamic_reconfigure::ConfigConstPtr&)> biases;
    std::function<void()> repeated;  ///< instead of a frame or an exposure that came twice
    std::function<void()> tick;      ///< every few milliseconds
    /// update() has something to do: from any thread, with no lock held.
    std::function<void()> on_change;
  };

  /// \param max_waiting_events in event arrays that wait for their callback
  NodeInputs(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
             std::size_t max_waiting_events, Handlers handlers);
  NodeInputs(const NodeInputs&) = delete;
  NodeInputs& operator=(const NodeInputs&) = delete;

  /// True when there is something to do for update().
  bool needsUpdate() const { return !subscribed_ || events_->needsUpdate(); }
  /// Subscribes to what is missing. Calls the master, and waits for it: not to be called with a
  /// lock held that a callback may want. One call at a time.
  /// \throws ros::Exception for an input that cannot be subscribed to; the next call goes on there
  void update();

  /// Whether an array is the one before once more; see repeated_messages.hpp.
  bool repeats(const WireEvents& events, std::uint32_t sequence) {
    return repeated_events_.repeats(events, sequence);
  }
  /// \return frames that are missing before the one with this header.seq
  std::uint64_t missingFramesBefore(std::uint32_t sequence);
  /// Bounds the events that wait from the next array on.
  void limitWaiting(std::size_t events) { events_->limitWaiting(events); }
  /// Suspends and resumes receiving events, see OverloadGuard.
  /// \return whether they are suspended now and were not before
  bool guardAgainstOverload(std::int64_t now_ns, const DeblurCounters& counts);

 private:
  template <typename Message>
  boost::function<void(const boost::shared_ptr<const Message>&)> once(
      const std::function<void(const boost::shared_ptr<const Message>&)>& handler,
      bool (RepeatedFrames::*came_twice)(const boost::shared_ptr<const void>&));

  const Handlers handlers_;
  RepeatedArrays repeated_events_;
  RepeatedFrames repeated_frames_;
  SequenceGaps image_gaps_;
  OverloadGuard overload_;
  std::unique_ptr<EventSubscription> events_;
  // Of update() alone:
  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
  std::optional<PeriodicCallback> clock_;
  image_transport::Subscriber image_;
  ros::Subscriber camera_info_;
  ros::Subscriber exposure_;
  ros::Subscriber biases_;
  bool subscribed_ = false;  ///< to all of them; the events may be suspended
};

}  // namespace fast_edi
