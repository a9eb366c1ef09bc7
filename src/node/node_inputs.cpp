#include "node/node_inputs.hpp"

#include <utility>

#include <ros/transport_hints.h>
#include <boost/function.hpp>

#include "node/queue_lengths.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kEventQueue = 1000;
constexpr std::uint32_t kImageQueue = 100;
constexpr std::uint32_t kExposureQueue = 100;
/// A fraction of the shortest sensible close timeout.
const ros::WallDuration kTickPeriod(0.004);

template <typename Message>
ros::Subscriber subscribe(
    ros::NodeHandle& nh, const char* topic, std::uint32_t queue,
    const boost::function<void(const boost::shared_ptr<const Message>&)>& handler,
    const ros::TransportHints& hints) {
  return nh.subscribe<Message>(topic, queue, handler, ros::VoidConstPtr(), hints);
}

}  // namespace

NodeInputs::NodeInputs(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                       std::size_t max_waiting_events, Handlers handlers)
    : handlers_(std::move(handlers)),
      events_(std::make_unique<EventSubscription>(
          nh, "events", WaitingArrays::Limits{kEventQueue, max_waiting_events}, handlers_.events,
          handlers_.lost_events, handlers_.on_change)),
      nh_(nh),
      private_nh_(private_nh) {}

/// roscpp calls one subscription's callbacks one at a time: no lock is needed.
template <typename Message>
boost::function<void(const boost::shared_ptr<const Message>&)> NodeInputs::once(
    const std::function<void(const boost::shared_ptr<const Message>&)>& handler,
    bool (RepeatedFrames::*came_twice)(const boost::shared_ptr<const void>&)) {
  return [this, &handler, came_twice](const boost::shared_ptr<const Message>& message) {
    if ((repeated_frames_.*came_twice)(message)) {
      handlers_.repeated();
    } else {
      handler(message);
    }
  };
}

/// One by one, so that what cannot be subscribed to keeps none of the others.
void NodeInputs::update() {
  if (subscribed_) {
    events_->update();
    return;
  }
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  if (!camera_info_) {
    camera_info_ = subscribe<sensor_msgs::CameraInfo>(nh_, "camera_info", kLatestWins,
                                                      handlers_.camera_info, no_delay);
  }
  if (!biases_) {
    // With explicit thresholds too: they may be given back to the biases live.
    biases_ = subscribe<dynamic_reconfigure::Config>(nh_, "bias_updates", kLatestWins,
                                                     handlers_.biases, no_delay);
  }
  if (!exposure_) {
    exposure_ = subscribe(nh_, "exposure", kExposureQueue,
                          once(handlers_.exposure, &RepeatedFrames::repeatsExposure), no_delay);
  }
  events_->update();
  if (!image_) {
    image_ = image_transport::ImageTransport(nh_).subscribe(
        "image_raw", kImageQueue, once(handlers_.image, &RepeatedFrames::repeatsImage),
        ros::VoidPtr(), image_transport::TransportHints("raw", no_delay, private_nh_));
  }
  clock_.emplace(nh_, kTickPeriod, handlers_.tick);
  subscribed_ = true;
}

std::uint64_t NodeInputs::missingFramesBefore(std::uint32_t sequence) {
  return image_gaps_.step(sequence) == SequenceStep::kGap ? image_gaps_.missing() : 0;
}

bool NodeInputs::guardAgainstOverload(std::int64_t now_ns, const DeblurCounters& counts) {
  switch (
      overload_.update(now_ns, {counts.events_in, counts.events_overflowed, counts.frames_in})) {
    case OverloadGuard::Action::kNone:
      break;
    case OverloadGuard::Action::kSuspend:
      return events_->suspend(handlers_.events_suspended);
    case OverloadGuard::Action::kResume:
      events_->resume();
      break;
  }
  return false;
}

}  // namespace fast_edi
