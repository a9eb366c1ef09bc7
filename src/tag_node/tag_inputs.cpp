#include "tag_node/tag_inputs.hpp"

#include <cstdint>

#include <image_transport/camera_common.h>
#include <ros/transport_hints.h>
#include <boost/function.hpp>

#include "node/queue_lengths.hpp"

namespace fast_edi {
namespace {

constexpr char kImage[] = "image";
/// Some frames may wait for a slow one; where all are slow, new ones are worth more than old ones.
constexpr std::uint32_t kImageQueue = 10;

}  // namespace

TagInputs::TagInputs(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                     const Handlers& handlers) {
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  camera_info_ = ros::NodeHandle(nh).subscribe<sensor_msgs::CameraInfo>(
      image_transport::getCameraInfoTopic(imageTopic(nh)), kLatestWins,
      boost::function<void(const sensor_msgs::CameraInfoConstPtr&)>(handlers.camera_info),
      ros::VoidConstPtr(), no_delay);
  image_ = image_transport::ImageTransport(nh).subscribe(
      kImage, kImageQueue, handlers.image, ros::VoidPtr(),
      image_transport::TransportHints("raw", no_delay, private_nh));
}

std::string TagInputs::imageTopic(const ros::NodeHandle& nh) {
  return nh.resolveName(kImage);
}

}  // namespace fast_edi
