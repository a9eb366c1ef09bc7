#include "tag_node/tag_detector_node.hpp"

#include <exception>
#include <utility>

#include <image_transport/camera_common.h>
#include <ros/console.h>
#include <ros/transport_hints.h>
#include <visualization_msgs/MarkerArray.h>

#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/messages/steady_time.hpp"
#include "fast_edi/tags/tag_drawing.hpp"
#include "node/parameter_loading.hpp"
#include "tag_node/tag_messages.hpp"

namespace fast_edi {
namespace {

/// Some frames may wait for a slow one; where all are slow, new ones are worth more than old ones.
constexpr std::uint32_t kImageQueue = 10;
constexpr std::uint32_t kLatestWins = 1;
constexpr std::uint32_t kOutputQueue = 100;
const ros::WallDuration kReportPeriod(1.0);

}  // namespace

TagDetectorNode::TagDetectorNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                                 const std::string& name)
    : nh_(nh),
      private_nh_(private_nh),
      name_(name),
      image_topic_(nh_.resolveName("image")),
      diagnostics_(image_topic_),
      warnings_(name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  updater_.emplace(nh_, private_nh_, name_);
  updater_->setHardwareID("none");
  updater_->add("tag detection", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    diagnostics_.fill(detection_time_, status);
  });
  configure();
  if (detector_) {
    advertise();
    if (!parameters_.lazy) {
      inputs_ = subscribe();
    }
  }
  report_timer_ =
      nh_.createSteadyTimer(kReportPeriod, [this](const ros::SteadyTimerEvent&) { report(); });
  callback_thread_.start();
}

TagDetectorNode::~TagDetectorNode() {
  callback_thread_.stop();
  report_timer_.stop();  // which looks at the inputs
  inputs_.reset();
  detections_publisher_.shutdown();
  annotated_publisher_.shutdown();
}

void TagDetectorNode::configure() {
  try {
    parameters_ = tagDetectorParametersFromYaml(privateParameters(private_nh_));
    detector_.emplace(parameters_.detector);
  } catch (const std::exception& error) {
    configuration_error_ = error.what();
    ROS_ERROR_STREAM(name_ << " stays idle, its configuration in " << private_nh_.getNamespace()
                           << " was refused:\n"
                           << configuration_error_);
  }
}

void TagDetectorNode::advertise() {
  const ros::SubscriberStatusCallback changed = [this](const ros::SingleSubscriberPublisher&) {
    subscribersChanged();
  };
  const image_transport::SubscriberStatusCallback image_changed =
      [this](const image_transport::SingleSubscriberPublisher&) { subscribersChanged(); };
  ros::NodeHandle nh = callback_thread_.handle(nh_);
  detections_publisher_ =
      nh.advertise<visualization_msgs::MarkerArray>("detections", kOutputQueue, changed, changed);
  annotated_publisher_ = image_transport::ImageTransport(nh).advertise(
      "image_annotated", kLatestWins, image_changed, image_changed);
}

std::unique_ptr<TagDetectorNode::Inputs> TagDetectorNode::subscribe() {
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  auto inputs = std::make_unique<Inputs>();
  inputs->camera_info =
      nh_.subscribe(image_transport::getCameraInfoTopic(image_topic_), kLatestWins,
                    &TagDetectorNode::receiveCameraInfo, this, no_delay);
  inputs->image = image_transport::ImageTransport(nh_).subscribe(
      "image", kImageQueue, &TagDetectorNode::receiveImage, this,
      image_transport::TransportHints("raw", no_delay, private_nh_));
  snapshot_.listening_since_ns = steadyNow();
  snapshot_.last_frame_ns = 0;
  gaps_.restart();
  return inputs;
}

void TagDetectorNode::subscribersChanged() {
  std::unique_ptr<Inputs> ended;  // destroyed after the mutex is released
  withLock([this, &ended] {
    if (!parameters_.lazy) {
      return;
    }
    const bool wanted = detections_publisher_.getNumSubscribers() > 0 ||
                        annotated_publisher_.getNumSubscribers() > 0;
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
    ++snapshot_.internal_errors;
    snapshot_.internal_error = error.what();
    warnings_.warn("internal error", snapshot_.internal_error, callback_start_ns_);
  }
}

void TagDetectorNode::receiveImage(const sensor_msgs::ImageConstPtr& message) {
  withLock([&] {
    snapshot_.last_frame_ns = callback_start_ns_;
    snapshot_.frame_gaps += gaps_.step(message->header.seq) == SequenceStep::kGap ? 1 : 0;
    const ImageReading reading = readImage(*message);
    if (reading.verdict != ImageVerdict::kSupported) {
      ++snapshot_.frames_refused;
      snapshot_.refusal = reading.reason;
      return;
    }
    const std::vector<TagDetection> tags = detector_->detect(greyPixels(*message));
    ++snapshot_.frames;
    snapshot_.frames_with_tags += tags.empty() ? 0 : 1;
    snapshot_.tags += tags.size();
    snapshot_.tags_in_last_frame = tags.size();
    publish(*message, tags);
    detection_time_.add(steadyNow() - callback_start_ns_);
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
  snapshot_.no_pose_reason = reading.reason;
  snapshot_.frame_id = header.frame_id;
  detections_publisher_.publish(makeTagMarkers(
      header, tags, reading.camera, {parameters_.detector.family, parameters_.tag_size_m}));
  if (annotated_publisher_.getNumSubscribers() > 0) {
    cv::Mat picture = colorPixels(image);
    drawTags(tags, picture);
    annotated_publisher_.publish(colorMessage(header, picture));
  }
}

void TagDetectorNode::report() {
  withLock([&] {
    snapshot_.time_ns = callback_start_ns_;
    snapshot_.configuration_error = configuration_error_;
    snapshot_.listening = inputs_ != nullptr;
    diagnostics_.update(snapshot_);
    for (const Complaint& complaint : diagnostics_.complaints()) {
      warnings_.warn(complaint.kind, complaint.text, callback_start_ns_);
    }
    updater_->force_update();
  });
}

}  // namespace fast_edi
