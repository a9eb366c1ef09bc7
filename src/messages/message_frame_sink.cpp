#include "fast_edi/messages/message_frame_sink.hpp"

#include <memory>
#include <utility>

#include <ros/time.h>
#include <boost/make_shared.hpp>

namespace fast_edi {

InputFrame makeInputFrame(const sensor_msgs::ImageConstPtr& message, const ImageReading& reading,
                          std::int64_t arrival_ns) {
  InputFrame frame;
  frame.stamp_ns = static_cast<std::int64_t>(message->header.stamp.toNSec());
  frame.image = reading.view;
  frame.supported = reading.verdict == ImageVerdict::kSupported;
  frame.owner = std::make_shared<const MessageFrame>(MessageFrame{message, arrival_ns});
  return frame;
}

const MessageFrame& messageFrame(const InputFrame& frame) {
  return *static_cast<const MessageFrame*>(frame.owner.get());
}

MessageFrameSink::MessageFrameSink(std::string frame_id, Deliver deliver)
    : frame_id_(std::move(frame_id)), deliver_(std::move(deliver)) {}

MutableImageView MessageFrameSink::begin(const InputFrame& input) {
  const sensor_msgs::Image& message = *messageFrame(input).message;
  if (!input.supported) {
    // The pipeline knows nothing of these pixels: an empty view for an empty view. What goes out is
    // the message as it came, padding included.
    image_ = boost::make_shared<sensor_msgs::Image>(message);
    return {};
  }
  image_ = makeImageLike(message, input.image.format);
  return viewOf(*image_, input.image.format);
}

void MessageFrameSink::setLatent(std::function<bool()> wanted, DeliverLatent deliver) {
  latent_wanted_ = std::move(wanted);
  deliver_latent_ = std::move(deliver);
}

sensor_msgs::ImagePtr MessageFrameSink::takeImage(std::int64_t stamp_ns) {
  image_->header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
  if (image_->header.frame_id.empty()) {
    image_->header.frame_id = frame_id_;
  }
  return std::exchange(image_, nullptr);
}

void MessageFrameSink::finish(const OutputFrame& output) {
  const sensor_msgs::ImagePtr image = takeImage(output.stamp_ns);
  const sensor_msgs::CameraInfoPtr info = makeCameraInfo(camera_info_.get(), *image);
  deliver_(image, info, output);
}

void MessageFrameSink::finishLatent(const InputFrame& input, std::int64_t stamp_ns) {
  static_cast<void>(input);
  deliver_latent_(takeImage(stamp_ns));
}

}  // namespace fast_edi
