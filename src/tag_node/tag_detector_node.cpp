#include "tag_node/tag_detector_node.hpp"

#include <exception>
#include <utility>

#include <ros/console.h>

#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/messages/steady_time.hpp"
#include "fast_edi/tags/tag_drawing.hpp"
#include "node/parameter_loading.hpp"
#include "tag_node/tag_messages.hpp"

namespace fast_edi {
namespace {

const ros::WallDuration kReportPeriod(1.0);

}  // namespace

TagDetectorNode::TagDetectorNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                                 const std::string& name)
    : nh_(nh), private_nh_(private_nh), report_(name, TagInputs::imageTopic(nh)) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.advertise(nh_, private_nh_, name);
  configure(name);
  if (detector_) {
    outputs_.advertise(callback_thread_.handle(nh_), [this] { subscribersChanged(); });
    if (!parameters_.lazy) {
      inputs_ = subscribe();
    }
  }
  reporting_.emplace(nh_, kReportPeriod, [this] { report(); });
  callback_thread_.start();
}

TagDetectorNode::~TagDetectorNode() {
  callback_thread_.stop();
  reporting_.reset();  // which looks at the inputs
  inputs_.reset();
  outputs_.shutdown();
}

void TagDetectorNode::configure(const std::string& name) {
  try {
    parameters_ = tagDetectorParametersFromYaml(privateParameters(private_nh_));
    detector_.emplace(parameters_.detector);
  } catch (const std::exception& error) {
    report_.totals().configuration_error = error.what();
    ROS_ERROR_STREAM(name << " stays idle, its configuration in " << private_nh_.getNamespace()
                          << " was refused:\n"
                          << error.what());
  }
}

/// \pre mutex_ is held
std::unique_ptr<TagInputs> TagDetectorNode::subscribe() {
  TagInputs::Handlers handlers;
  handlers.image = [this](const sensor_msgs::ImageConstPtr& message) { receiveImage(message); };
  handlers.camera_info = [this](const sensor_msgs::CameraInfoConstPtr& message) {
    receiveCameraInfo(message);
  };
  auto inputs = std::make_unique<TagInputs>(nh_, private_nh_, handlers);
  report_.startListening(steadyNow());
  return inputs;
}

void TagDetectorNode::subscribersChanged() {
  std::unique_ptr<TagInputs> ended;  // destroyed after the mutex is released
  withLock([this, &ended] {
    if (!parameters_.lazy) {
      return;
    }
    const bool wanted = outputs_.areWanted();
    if (wanted && !inputs_) {
      inputs_ = subscribe();
    } else if (!wanted && inputs_) {
      ended = std::move(inputs_);
    }
  });
}

template <typename Work>
void TagDetectorNode::withLock(Work&& work) {
  const std::lock_guard<std::mutex> lock(mutex_);
  callback_start_ns_ = steadyNow();
  try {
    work();
  } catch (const std::exception& error) {
    report_.addInternalError(error.what(), callback_start_ns_);
  }
}

void TagDetectorNode::receiveImage(const sensor_msgs::ImageConstPtr& message) {
  withLock([&] {
    if (report_.repeats(message)) {
      return;
    }
    report_.addArrival(message->header.seq, callback_start_ns_);
    const ImageReading reading = readImage(*message);
    if (reading.verdict != ImageVerdict::kSupported) {
      report_.addRefusedImage(reading.reason);
      return;
    }
    const std::vector<TagDetection> tags = detector_->detect(greyPixels(*message));
    report_.addFrame(tags.size());
    publish(*message, tags);
    report_.addDetectionTime(steadyNow() - callback_start_ns_);
  });
}

void TagDetectorNode::receiveCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
  withLock([&] { camera_info_ = message; });
}

void TagDetectorNode::publish(const sensor_msgs::Image& image,
                              const std::vector<TagDetection>& tags) {
  std_msgs::Header header = image.header;
  if (header.frame_id.empty()) {
    header.frame_id = parameters_.frame_id;
  }
  const cv::Size size(static_cast<int>(image.width), static_cast<int>(image.height));
  const CameraReading reading = readCamera(camera_info_.get(), size, parameters_.rectified);
  report_.totals().no_pose_reason = reading.reason;
  report_.totals().frame_id = header.frame_id;
  outputs_.publishDetections(makeTagMarkers(header, tags, reading.camera,
                                            {parameters_.detector.family, parameters_.tag_size_m}));
  if (outputs_.isAnnotatedWanted()) {
    cv::Mat picture = colourPixels(image);
    drawTags(tags, picture);
    outputs_.publishAnnotated(colourMessage(header, picture));
  }
}

void TagDetectorNode::report() {
  withLock([&] { report_.publish(inputs_ != nullptr, callback_start_ns_); });
}

}  // namespace fast_edi
