#include "stream_node/dv_stream_node.hpp"

#include <chrono>
#include <exception>
#include <optional>

#include <ros/console.h>

#include "fast_edi/messages/steady_time.hpp"
#include "node/parameter_loading.hpp"
#include "stream_node/camera_info_file.hpp"

namespace fast_edi {
namespace {

const ros::WallDuration kReportPeriod(1.0);

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

DvStreamNode::DvStreamNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                           const std::string& name)
    : nh_(nh), private_nh_(private_nh), name_(name), publisher_(name) {
  publisher_.advertise(
      nh_, private_nh_, name, "streams of DV",
      [this](diagnostic_updater::DiagnosticStatusWrapper& status) { diagnostics_.fill(status); });
  try {
    configure();
  } catch (const std::exception& error) {
    clients_.clear();
    configuration_error_ = error.what();
    ROS_ERROR_STREAM(name << " stays idle, its configuration in " << private_nh_.getNamespace()
                          << " was refused:\n"
                          << error.what());
  }
  reporting_.emplace(nh_, kReportPeriod, [this] { report(); });
}

DvStreamNode::~DvStreamNode() = default;

void DvStreamNode::configure() {
  const DvStreamParameters parameters = dvStreamParametersFromYaml(privateParameters(private_nh_));
  std::optional<sensor_msgs::CameraInfo> calibration;
  if (!parameters.camera_info_file.empty()) {
    calibration = readCameraInfoFile(parameters.camera_info_file);
  }
  if (parameters.events.isGiven()) {
    events_ = std::make_unique<EventOutput>(nh_, parameters.frame_id);
    connect(parameters, StreamKind::kEvents, parameters.events, *events_);
  }
  if (parameters.frames.isGiven()) {
    frames_ = std::make_unique<FrameOutput>(nh_, parameters.frame_id, calibration);
    connect(parameters, StreamKind::kFrames, parameters.frames, *frames_);
  }
  if (parameters.imu.isGiven()) {
    imu_ = std::make_unique<ImuOutput>(nh_);
    connect(parameters, StreamKind::kImu, parameters.imu, *imu_);
  }
  if (parameters.triggers.isGiven()) {
    triggers_ = std::make_unique<TriggerOutput>(nh_);
    connect(parameters, StreamKind::kTriggers, parameters.triggers, *triggers_);
  }
}

void DvStreamNode::connect(const DvStreamParameters& parameters, StreamKind kind,
                           const DvStreamPlace& place, StreamSink& sink) {
  StreamSettings settings;
  settings.endpoint.address = parameters.address;
  settings.endpoint.port = static_cast<std::uint16_t>(place.port);
  settings.endpoint.socket_path = place.socket;
  settings.kind = kind;
  settings.stall_timeout = milliseconds(parameters.stall_timeout_s);
  settings.max_retry = milliseconds(parameters.max_retry_s);
  clients_.push_back(std::make_unique<StreamClient>(settings, sink));
}

void DvStreamNode::report() {
  StreamSnapshot snapshot;
  snapshot.time_ns = steadyNow();
  snapshot.configuration_error = configuration_error_;
  for (const auto& client : clients_) {
    snapshot.streams.push_back(
        {client->settings().kind, toString(client->settings().endpoint), client->status()});
  }
  if (frames_) {
    snapshot.frames_without_exposure = frames_->withoutExposure();
    snapshot.frames_without_calibration = frames_->withoutCalibration();
  }
  diagnostics_.update(snapshot);
  for (const std::string& text : diagnostics_.news()) {
    ROS_INFO_STREAM(name_ << ": " << text);
  }
  publisher_.publish(diagnostics_.complaints(), snapshot.time_ns);
}

}  // namespace fast_edi
