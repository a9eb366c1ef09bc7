#include "node/deblur_node.hpp"

#include <exception>
#include <utility>

#include <ros/console.h>
#include <ros/master.h>

#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/messages/steady_time.hpp"
#include "node/parameter_loading.hpp"

namespace fast_edi {
namespace {

const ros::WallDuration kReportPeriod(1.0);
/// Of what has to wait for the ROS master.
const ros::WallDuration kRetryPeriod(0.5);
/// 1 / kWaitingShare of `max_buffered_events` is reserved for arrays that wait for their callback;
/// they may also use what the pipeline leaves.
constexpr std::size_t kWaitingShare = 4;

/// What the pipeline may take of `max_buffered_events`.
DeblurParameters forPipeline(DeblurParameters parameters) {
  parameters.max_buffered_events -= parameters.max_buffered_events / kWaitingShare;
  return parameters;
}

InputTopics resolvedTopics(const ros::NodeHandle& nh) {
  return {nh.resolveName("events"), nh.resolveName("image_raw"), nh.resolveName("exposure"),
          nh.resolveName("bias_updates")};
}

}  // namespace

DeblurNode::DeblurNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                       const std::string& name)
    : DeblurNode(nh, private_nh, name, NotStarted{}) {
  start();
}

DeblurNode::DeblurNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                       const std::string& name, NotStarted)
    : nh_(nh), private_nh_(private_nh), name_(name), report_(name, resolvedTopics(nh_)) {}

void DeblurNode::start() {
  report_.advertise(nh_, private_nh_, name_);
  configure();
  if (deblurrer_) {
    outputs_.advertise(callback_thread_.handle(nh_), parameters_->get().deblur.latent,
                       [this] { subscribersChanged(); });
    reconfigure_server_ = std::make_unique<ReconfigureServer>(
        callback_thread_.handle(private_nh_), parameters_->values(),
        [this](const LiveParameters::Values& wanted) { return reconfigure(wanted); });
    if (!parameters_->get().ros.lazy) {
      inputs_ = makeInputs();
    }
    learned_service_.emplace(callback_thread_.handle(private_nh_),
                             learnedFilePath(parameters_->get().ros.learned_file, name_),
                             [this] { return status(); });
    callback_thread_.repeat(nh_, kRetryPeriod, [this] { updateInputs(); });
    callback_thread_.post([this] { updateInputs(); });
    callback_thread_.start();
  }
  reporting_.emplace(nh_, kReportPeriod, [this] { report(); });
}

DeblurNode::~DeblurNode() {
  // Each of these waits for callbacks at work, which may wait for the mutex.
  callback_thread_.stop();
  reconfigure_server_.reset();
  learned_service_.reset();
  std::unique_ptr<NodeInputs> ended;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended = std::move(inputs_);
  }
  ended.reset();
  reporting_.reset();
  outputs_.shutdown();
}

void DeblurNode::configure() {
  try {
    parameters_.emplace(privateParameters(private_nh_), name_, nh_.resolveName("bias_updates"),
                        [this](const DeblurParameters& parameters) {
                          deblurrer_->setParameters(forPipeline(parameters));
                        });
    sink_.emplace(parameters_->get().ros.frame_id,
                  [this](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                         const OutputFrame& output) { deliver(image, info, output); });
    sink_->setLatent([this] { return outputs_.isLatentWanted(); },
                     [this](const sensor_msgs::ImagePtr& image) { outputs_.publishLatent(image); });
    deblurrer_ = std::make_unique<Deblurrer>(forPipeline(parameters_->get().deblur), *sink_);
  } catch (const std::exception& error) {
    report_.totals().configuration_error = error.what();
    ROS_ERROR_STREAM(name_ << " stays idle, its configuration in " << private_nh_.getNamespace()
                           << " was refused:\n"
                           << error.what());
    return;
  }
  parameters_->logContrast();
}

/// \pre mutex_ is held, or no callback can come yet
std::unique_ptr<NodeInputs> DeblurNode::makeInputs() {
  NodeInputs::Handlers handlers;
  handlers.events = [this](const WireEvents& events, SensorSize size, std::uint32_t sequence,
                           std::int64_t arrived_ns) {
    receiveEvents(events, size, sequence, arrived_ns);
  };
  handlers.lost_events = [this](std::size_t events) {
    withInputs([&] { deblurrer_->noteLostEvents(events); });
  };
  handlers.events_suspended = [this] { withInputs([&] { deblurrer_->noteMissingArrays(); }); };
  handlers.image = [this](const sensor_msgs::ImageConstPtr& message) { receiveImage(message); };
  handlers.camera_info = [this](const sensor_msgs::CameraInfoConstPtr& message) {
    receiveCameraInfo(message);
  };
  handlers.exposure = [this](const std_msgs::Int32ConstPtr& message) {
    withInputs([&] { deblurrer_->addExposure(message->data, callback_.start_ns); });
  };
  handlers.biases = [this](const dynamic_reconfigure::ConfigConstPtr& message) {
    withInputs([&] { report_.addRefusedBiases(parameters_->followBiases(message)); });
  };
  handlers.repeated = [this] { withInputs([&] { ++report_.totals().messages_repeated; }); };
  handlers.tick = [this] { advanceClock(); };
  handlers.on_change = [this] { callback_thread_.post([this] { updateInputs(); }); };
  report_.startListening(steadyNow());
  return std::make_unique<NodeInputs>(nh_, private_nh_, maxWaitingEvents(), std::move(handlers));
}

void DeblurNode::updateInputs() {
  if (!inputs_) {
    return;
  }
  // Without the master nothing is given up either: it could not be had back.
  const bool reachable = !inputs_->needsUpdate() || ros::master::check();
  std::string error;
  if (reachable) {
    try {
      inputs_->update();
    } catch (const std::exception& exception) {
      error = exception.what();
    }
  }
  withLock([&] {
    report_.totals().master_missing = !reachable;
    if (!error.empty()) {
      report_.addInternalError(error, callback_.start_ns);
    }
  });
}

void DeblurNode::subscribersChanged() {
  std::unique_ptr<NodeInputs> ended;  // destroyed after the mutex is released
  withLock([this, &ended] {
    const LoadedParameters& parameters = parameters_->get();
    if (!parameters.ros.lazy) {
      return;
    }
    const bool wanted = outputs_.areWanted(parameters.deblur.latent);
    if (wanted && !inputs_) {
      inputs_ = makeInputs();
    } else if (!wanted && inputs_) {
      ended = std::move(inputs_);
      deblurrer_->pause();
      outputs_.clearComparedEvents();
    }
  });
  updateInputs();
}

template <typename Work>
void DeblurNode::withLock(Work&& work) {
  const std::lock_guard<std::mutex> lock(mutex_);
  callback_.start_ns = steadyNow();
  callback_.arrived_ns = callback_.start_ns;
  try {
    work();
  } catch (const std::exception& error) {
    report_.addInternalError(error.what(), callback_.start_ns);
    if (deblurrer_) {
      deblurrer_->pause();
    }
  }
}

template <typename Work>
void DeblurNode::withInputs(Work&& work) {
  withLock([&] {
    if (inputs_) {
      work();
    }
  });
}

void DeblurNode::receiveEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                               std::int64_t arrived_ns) {
  withInputs([&] {
    if (inputs_->repeats(events, sequence)) {
      ++report_.totals().messages_repeated;
      return;
    }
    // What the array cost and waited before this callback belongs to the latency of the frame that
    // it completes.
    callback_.arrived_ns = arrived_ns;
    report_.totals().last_events_ns = callback_.start_ns;
    // First: these events may close the frame that they belong to.
    outputs_.addComparedEvents(events, size, parameters_->get().deblur.event_mapping);
    deblurrer_->addEvents(events, size, sequence, callback_.start_ns);
    inputs_->limitWaiting(maxWaitingEvents());
  });
}

/// What buffered events leave of `max_buffered_events` to those that wait.
std::size_t DeblurNode::maxWaitingEvents() const {
  return parameters_->get().deblur.max_buffered_events - deblurrer_->bufferedEvents();
}

void DeblurNode::receiveImage(const sensor_msgs::ImageConstPtr& message) {
  withInputs([&] {
    NodeSnapshot& totals = report_.totals();
    totals.last_frame_ns = callback_.start_ns;
    totals.frames_missing += inputs_->missingFramesBefore(message->header.seq);
    const ImageReading reading = readImage(*message);
    if (reading.verdict == ImageVerdict::kMalformed) {
      ++totals.frames_malformed;
      totals.malformed_reason = reading.reason;
      return;
    }
    if (reading.verdict == ImageVerdict::kUnsupported) {
      totals.unsupported_reason = reading.reason;
    }
    deblurrer_->addFrame(makeInputFrame(message, reading, callback_.start_ns), callback_.start_ns);
  });
}

void DeblurNode::receiveCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
  withInputs([&] {
    const std::string fault = cameraInfoFault(*message);
    fault.empty() ? sink_->setCameraInfo(message) : report_.addRefusedCameraInfo(fault);
  });
}

void DeblurNode::advanceClock() {
  withInputs([&] {
    deblurrer_->advance(callback_.start_ns);
    const bool suspends = inputs_->guardAgainstOverload(callback_.start_ns, deblurrer_->counters());
    report_.totals().event_suspensions += suspends ? 1 : 0;
  });
}

LiveParameters::Values DeblurNode::reconfigure(const LiveParameters::Values& wanted) {
  LiveParameters::Values in_force;
  withLock([&] {
    const ParametersInForce::Refusals refusals = parameters_->change(wanted);
    ++report_.totals().reconfigurations;
    for (const std::string& refusal : refusals.values) {
      report_.addRefusedValue(refusal);
      report_.warnings().note("values", callback_.start_ns);  // which have been logged
    }
    if (!refusals.request.empty()) {
      report_.addRefusedValue("all values of one request: " + refusals.request);
    }
    report_.addRefusedBiases(refusals.biases);
    in_force = parameters_->values();
    const std::string fault = outputs_.latentQueueFault(parameters_->get().deblur.latent);
    if (!fault.empty()) {
      report_.warnings().warn("latent queue", fault, callback_.start_ns);
    }
  });
  subscribersChanged();  // those of latent images count only while there are any
  return in_force;
}

void DeblurNode::deliver(const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                         const OutputFrame& output) {
  outputs_.publish(image, info);
  report_.addOutput(steadyNow(), callback_.arrived_ns, messageFrame(output.input).arrival_ns);
  if (output.input.supported && outputs_.isComparisonWanted()) {
    publishComparison(*image, output);
  }
}

void DeblurNode::publishComparison(const sensor_msgs::Image& image, const OutputFrame& output) {
  const std::int64_t offset_ns = deblurrer_->parameters().time_offset_ns;
  const ExposureInterval window{output.exposure.start_ns + offset_ns,
                                output.exposure.end_ns + offset_ns};
  const std::string fault =
      outputs_.publishComparison(*messageFrame(output.input).message, image, window);
  if (!fault.empty()) {
    report_.warnings().warn("comparison", "no comparison picture: " + fault, callback_.start_ns);
  }
}

DeblurStatus DeblurNode::status() {
  DeblurStatus status;
  withLock([&] { status = deblurrer_->status(); });
  return status;
}

void DeblurNode::report() {
  withLock([&] {
    if (deblurrer_) {
      report_.setPipeline(*deblurrer_, parameters_->get().contrast_origin, inputs_ != nullptr);
    }
    report_.publish(callback_.start_ns);
  });
}

}  // namespace fast_edi
