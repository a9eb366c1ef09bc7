/// \file
/// What a deblurring node publishes: deblurred frames, the high-rate video, the comparison.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_mapping.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/latent/latent_instants.hpp"
#include "node/comparison_view.hpp"

namespace fast_edi {

class NodeOutputs {
 public:
  /// Once.
  /// \param latent sampling of the video at the start, for which its queue has room
  /// \param on_change called from \p nh's callback queue when a subscriber comes or goes
  void advertise(const ros::NodeHandle& nh, const LatentSampling& latent,
                 const std::function<void()>& on_change);
  /// Ends all publishers. Waits for a callback at work: the caller must hold no lock that this may
  /// want.
  void shutdown();

  /// Whether an output that is produced has a subscriber.
  bool areWanted(const LatentSampling& latent) const;
  bool isComparisonWanted() const { return comparison_.getNumSubscribers() > 0; }
  bool isLatentWanted() const { return latent_.getNumSubscribers() > 0; }

  void publish(const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info) {
    deblurred_.publish(image, info);
  }
  void publishLatent(const sensor_msgs::ImagePtr& image) { latent_.publish(image); }
  /// What a queue that is too short for \p latent means; empty if it is long enough.
  std::string latentQueueFault(const LatentSampling& latent) const;

  /// Events that a comparison may show; nothing is kept while it has no subscriber.
  void addComparedEvents(const WireEvents& events, SensorSize size, const EventMapping& mapping);
  void clearComparedEvents() { view_.clear(); }
  /// \param window the exposure in event time
  /// \return why there is none; empty if there is
  std::string publishComparison(const sensor_msgs::Image& input, const sensor_msgs::Image& output,
                                const ExposureInterval& window);

 private:
  image_transport::CameraPublisher deblurred_;
  image_transport::Publisher comparison_;
  image_transport::Publisher latent_;
  std::uint32_t latent_queue_ = 0;  ///< [images]
  ComparisonView view_;
};

}  // namespace fast_edi
