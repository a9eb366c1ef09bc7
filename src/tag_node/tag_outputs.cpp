#include "tag_node/tag_outputs.hpp"

#include <cstdint>

#include "node/queue_lengths.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kOutputQueue = 100;

}  // namespace

void TagOutputs::advertise(const ros::NodeHandle& nh, const std::function<void()>& on_change) {
  const ros::SubscriberStatusCallback changed = [on_change](const ros::SingleSubscriberPublisher&) {
    on_change();
  };
  const image_transport::SubscriberStatusCallback image_changed =
      [on_change](const image_transport::SingleSubscriberPublisher&) { on_change(); };
  detections_ = ros::NodeHandle(nh).advertise<visualization_msgs::MarkerArray>(
      "detections", kOutputQueue, changed, changed);
  annotated_ = image_transport::ImageTransport(nh).advertise("image_annotated", kLatestWins,
                                                             image_changed, image_changed);
}

void TagOutputs::shutdown() {
  detections_.shutdown();
  annotated_.shutdown();
}

}  // namespace fast_edi
