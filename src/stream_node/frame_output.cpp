#include "stream_node/frame_output.hpp"

#include <utility>
#include <variant>

#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>
#include <boost/make_shared.hpp>

#include "messages/recorded_messages.hpp"

namespace fast_edi {
namespace {

/// Messages that wait for a subscriber in another process: seconds, at the rate of any camera.
constexpr std::uint32_t kFrameQueue = 100;

}  // namespace

FrameOutput::FrameOutput(ros::NodeHandle nh, std::string frame_id,
                         std::optional<sensor_msgs::CameraInfo> calibration)
    : frame_id_(std::move(frame_id)),
      calibration_(std::move(calibration)),
      image_(nh.advertise<sensor_msgs::Image>("image_raw", kFrameQueue)),
      exposure_(nh.advertise<std_msgs::Int32>("exposure", kFrameQueue)) {
  if (calibration_) {
    camera_info_ = nh.advertise<sensor_msgs::CameraInfo>("camera_info", kFrameQueue);
  }
}

void FrameOutput::begin(const RecordedStream&) {}

void FrameOutput::add(const RecordingItem& item) {
  const auto* frame = std::get_if<RecordedFrame>(&item.content);
  if (frame == nullptr) {
    return;
  }
  without_exposure_ += frame->exposure ? 0 : 1;
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.seq = sequence_++;
  image->header.frame_id = frame_id_;
  fillImage(*frame, *image);
  if (calibration_) {
    publishCalibration(*frame, image->header);
  }
  image_.publish(image);
  if (frame->exposure) {
    exposure_.publish(boost::make_shared<std_msgs::Int32>(exposureMessage(*frame->exposure)));
  }
}

void FrameOutput::publishCalibration(const RecordedFrame& frame, const std_msgs::Header& header) {
  if (static_cast<int>(calibration_->width) != frame.size.width ||
      static_cast<int>(calibration_->height) != frame.size.height) {
    ++without_calibration_;
    return;
  }
  auto info = boost::make_shared<sensor_msgs::CameraInfo>(*calibration_);
  info->header = header;
  camera_info_.publish(info);
}

}  // namespace fast_edi
