#include "node/node_outputs.hpp"

#include <algorithm>
#include <exception>

#include "node/queue_lengths.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kOutputQueue = 100;
/// Frames whose latent images fit into their queue. One brings up to twice `latent_images` at once.
constexpr int kLatentQueueFrames = 2;
/// Room for 100 latent images for each exposure; a slow subscriber holds 36 MB at 346 x 260.
constexpr std::uint32_t kLatentQueue = 400;

/// \return queue that this many latent images need [images]
std::uint32_t latentQueueFor(const LatentSampling& latent) {
  return static_cast<std::uint32_t>(2 * kLatentQueueFrames * latent.per_exposure);
}

}  // namespace

void NodeOutputs::advertise(const ros::NodeHandle& nh, const LatentSampling& latent,
                            const std::function<void()>& on_change) {
  image_transport::ImageTransport transport(nh);
  const image_transport::SubscriberStatusCallback image_changed =
      [on_change](const image_transport::SingleSubscriberPublisher&) { on_change(); };
  const ros::SubscriberStatusCallback info_changed =
      [on_change](const ros::SingleSubscriberPublisher&) { on_change(); };
  deblurred_ = transport.advertiseCamera("deblurred/image_raw", kOutputQueue, image_changed,
                                         image_changed, info_changed, info_changed);
  comparison_ = transport.advertise("comparison", kLatestWins, image_changed, image_changed);
  // Also while `latent_images` is 0: it may be changed live.
  latent_queue_ = std::max(kLatentQueue, latentQueueFor(latent));
  latent_ = transport.advertise("latent/image_raw", latent_queue_, image_changed, image_changed);
}

void NodeOutputs::shutdown() {
  deblurred_.shutdown();
  comparison_.shutdown();
  latent_.shutdown();
}

bool NodeOutputs::areWanted(const LatentSampling& latent) const {
  return deblurred_.getNumSubscribers() > 0 || isComparisonWanted() ||
         (latent.isOn() && isLatentWanted());
}

std::string NodeOutputs::latentQueueFault(const LatentSampling& latent) const {
  const std::uint32_t needed = latentQueueFor(latent);
  if (needed <= latent_queue_) {
    return {};
  }
  return "the queue of " + latent_.getTopic() + " holds " + std::to_string(latent_queue_) +
         " images, expected " + std::to_string(needed) +
         " for this many latent images: slow subscribers may lose some; set latent_images before "
         "the node starts";
}

std::string NodeOutputs::publishComparison(const sensor_msgs::Image& input,
                                           const sensor_msgs::Image& output,
                                           const ExposureInterval& window) {
  try {
    comparison_.publish(view_.draw(input, output, window));
  } catch (const std::exception& error) {
    // A picture for people must not disturb the pipeline that it is drawn in the middle of.
    return error.what();
  }
  return {};
}

void NodeOutputs::addComparedEvents(const WireEvents& events, SensorSize size,
                                    const EventMapping& mapping) {
  if (isComparisonWanted()) {
    view_.addEvents(events, size, mapping);
  } else {
    view_.clear();
  }
}

}  // namespace fast_edi
