#include "node/deblur_node.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>
#include <vector>

#include <ros/console.h>
#include <ros/master.h>
#include <ros/transport_hints.h>

#include "fast_edi/base/number_text.hpp"
#include "fast_edi/calibration/contrast_from_bias.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/messages/steady_time.hpp"
#include "node/bias_update.hpp"
#include "node/parameter_loading.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kEventQueue = 1000;
constexpr std::uint32_t kImageQueue = 100;
constexpr std::uint32_t kExposureQueue = 100;
constexpr std::uint32_t kLatestWins = 1;
constexpr std::uint32_t kOutputQueue = 100;
/// Frames whose latent images fit into their queue. One brings up to twice `latent_images` at once.
constexpr int kLatentQueueFrames = 2;
/// Room for 100 latent images for each exposure; a slow subscriber holds 36 MB at 346 x 260.
constexpr std::uint32_t kLatentQueue = 400;
/// A fraction of the shortest sensible close timeout.
const ros::WallDuration kAdvancePeriod(0.004);
const ros::WallDuration kReportPeriod(1.0);
/// Of what has to wait for the ROS master.
const ros::WallDuration kRetryPeriod(0.5);
/// One part in so many of `max_buffered_events` is for nothing but arrays that wait for their
/// callback; more of it while the pipeline leaves more.
constexpr std::size_t kWaitingShare = 4;

/// What the pipeline may take of `max_buffered_events`.
DeblurParameters forPipeline(DeblurParameters parameters) {
  parameters.max_buffered_events -= parameters.max_buffered_events / kWaitingShare;
  return parameters;
}

/// \return queue that this many latent images need [images]
std::uint32_t latentQueueFor(const LatentSampling& latent) {
  return static_cast<std::uint32_t>(2 * kLatentQueueFrames * latent.per_exposure);
}

}  // namespace

DeblurNode::DeblurNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                       const std::string& name)
    : DeblurNode(nh, private_nh, name, NotStarted{}) {
  start();
}

DeblurNode::DeblurNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                       const std::string& name, NotStarted)
    : nh_(nh),
      private_nh_(private_nh),
      name_(name),
      topics_{nh_.resolveName("events"), nh_.resolveName("image_raw"), nh_.resolveName("exposure"),
              nh_.resolveName("bias_updates")},
      diagnostics_(topics_),
      warnings_(name) {}

void DeblurNode::start() {
  updater_.emplace(nh_, private_nh_, name_);
  updater_->setHardwareID("none");
  updater_->add("deblurring", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    diagnostics_.fill(close_latency_, output_latency_, status);
  });
  configure();
  if (deblurrer_) {
    advertise();
    reconfigure_server_ = std::make_unique<ReconfigureServer>(
        side_thread_.handle(private_nh_), live_->values(),
        [this](const LiveParameters::Values& wanted) { return reconfigure(wanted); });
    if (!parameters_.ros.lazy) {
      inputs_ = makeInputs();
    }
    retry_timer_ = side_thread_.handle(nh_).createSteadyTimer(
        kRetryPeriod, [this](const ros::SteadyTimerEvent&) { updateInputs(); });
    side_thread_.post([this] { updateInputs(); });
    side_thread_.start();
  }
  report_timer_ =
      nh_.createSteadyTimer(kReportPeriod, [this](const ros::SteadyTimerEvent&) { report(); });
}

DeblurNode::~DeblurNode() {
  // Each of these waits for callbacks at work, which may wait for the mutex.
  side_thread_.stop();
  reconfigure_server_.reset();
  std::unique_ptr<Inputs> ended;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended = std::move(inputs_);
  }
  retry_timer_.stop();
  ended.reset();
  report_timer_.stop();
  deblurred_publisher_.shutdown();
  comparison_publisher_.shutdown();
  latent_publisher_.shutdown();
}

void DeblurNode::configure() {
  try {
    const YAML::Node root = privateParameters(private_nh_);
    parameters_ = parametersFromYaml(root, "");
    live_.emplace(parameters_, root);
    sink_.emplace(parameters_.ros.frame_id,
                  [this](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                         const OutputFrame& output) { deliver(image, info, output); });
    sink_->setLatent(
        [this] { return latent_publisher_.getNumSubscribers() > 0; },
        [this](const sensor_msgs::ImagePtr& image) { latent_publisher_.publish(image); });
    deblurrer_ = std::make_unique<Deblurrer>(forPipeline(parameters_.deblur), *sink_);
  } catch (const std::exception& error) {
    configuration_error_ = error.what();
    ROS_ERROR_STREAM(name_ << " stays idle, its configuration in " << private_nh_.getNamespace()
                           << " was refused:\n"
                           << configuration_error_);
    return;
  }
  announceContrast();
}

void DeblurNode::announceContrast() const {
  const ContrastThresholds& thresholds = parameters_.deblur.thresholds;
  ROS_INFO_STREAM(name_ << ": contrast thresholds ON " << numberText(thresholds.on) << ", OFF "
                        << numberText(thresholds.off) << " from " << parameters_.contrast_origin);
  for (const std::string& warning : contrastWarnings(thresholds)) {
    ROS_WARN_STREAM(name_ << ": " << warning);
  }
}

void DeblurNode::advertise() {
  const ros::NodeHandle nh = side_thread_.handle(nh_);
  image_transport::ImageTransport transport(nh);
  const image_transport::SubscriberStatusCallback image_changed =
      [this](const image_transport::SingleSubscriberPublisher&) { subscribersChanged(); };
  const ros::SubscriberStatusCallback info_changed = [this](const ros::SingleSubscriberPublisher&) {
    subscribersChanged();
  };
  deblurred_publisher_ =
      transport.advertiseCamera("deblurred/image_raw", kOutputQueue, image_changed, image_changed,
                                info_changed, info_changed);
  comparison_publisher_ =
      transport.advertise("comparison", kLatestWins, image_changed, image_changed);
  // Also while `latent_images` is 0: it may be changed while we run.
  latent_queue_ = std::max(kLatentQueue, latentQueueFor(parameters_.deblur.latent));
  latent_publisher_ =
      transport.advertise("latent/image_raw", latent_queue_, image_changed, image_changed);
}

/// Whether somebody listens to an output that has something to say.
bool DeblurNode::isWanted() const {
  return deblurred_publisher_.getNumSubscribers() > 0 ||
         comparison_publisher_.getNumSubscribers() > 0 ||
         (parameters_.deblur.latent.isOn() && latent_publisher_.getNumSubscribers() > 0);
}

/// \pre mutex_ is held, or no callback can come yet
std::unique_ptr<DeblurNode::Inputs> DeblurNode::makeInputs() {
  auto inputs = std::make_unique<Inputs>();
  inputs->events = std::make_unique<EventSubscription>(
      nh_, "events", WaitingArrays::Limits{kEventQueue, waitingLimit()},
      [this](const WireEvents& events, SensorSize size, std::uint32_t sequence,
             std::int64_t arrived_ns) { receiveEvents(events, size, sequence, arrived_ns); },
      [this](std::size_t lost) { receiveLoss(lost); },
      [this] { side_thread_.post([this] { updateInputs(); }); });
  totals_.listening_since_ns = steadyNow();
  totals_.last_frame_ns = 0;
  totals_.last_events_ns = 0;
  return inputs;
}

/// One by one, so that what cannot be subscribed to keeps none of the others.
void DeblurNode::subscribe(Inputs& inputs) {
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  if (!inputs.camera_info) {
    inputs.camera_info =
        nh_.subscribe("camera_info", kLatestWins, &DeblurNode::receiveCameraInfo, this, no_delay);
  }
  if (!inputs.bias_updates) {
    // With explicit thresholds too: they may be given back to the biases while we listen.
    inputs.bias_updates =
        nh_.subscribe("bias_updates", kLatestWins, &DeblurNode::receiveBiasUpdate, this, no_delay);
  }
  if (!inputs.exposure) {
    inputs.exposure =
        nh_.subscribe("exposure", kExposureQueue, &DeblurNode::receiveExposure, this, no_delay);
  }
  inputs.events->update();
  if (!inputs.image) {
    inputs.image = image_transport::ImageTransport(nh_).subscribe(
        "image_raw", kImageQueue, &DeblurNode::receiveImage, this,
        image_transport::TransportHints("raw", no_delay, private_nh_));
  }
  inputs.advance_timer = nh_.createSteadyTimer(
      kAdvancePeriod, [this](const ros::SteadyTimerEvent&) { advanceClock(); });
  inputs.subscribed = true;
}

void DeblurNode::updateInputs() {
  if (!inputs_) {
    return;
  }
  // Without the master nothing is given up either: it could not be had back.
  const bool needs_master = !inputs_->subscribed || inputs_->events->needsUpdate();
  const bool reachable = !needs_master || ros::master::check();
  std::string error;
  if (reachable) {
    try {
      if (!inputs_->subscribed) {
        subscribe(*inputs_);
      } else {
        inputs_->events->update();
      }
    } catch (const std::exception& exception) {
      error = exception.what();
    }
  }
  guarded([&] {
    totals_.master_missing = !reachable;
    if (!error.empty()) {
      noteInternalError(error);
    }
  });
}

void DeblurNode::subscribersChanged() {
  std::unique_ptr<Inputs> ended;  // destroyed after the mutex is released
  guarded([this, &ended] {
    if (!parameters_.ros.lazy) {
      return;
    }
    const bool wanted = isWanted();
    if (wanted && !inputs_) {
      inputs_ = makeInputs();
    } else if (!wanted && inputs_) {
      ended = std::move(inputs_);
      deblurrer_->pause();
      comparison_.clear();
    }
  });
  updateInputs();
}

template <typename Work>
void DeblurNode::guarded(Work&& work) {
  const std::lock_guard<std::mutex> lock(mutex_);
  callback_start_ns_ = steadyNow();
  message_arrived_ns_ = callback_start_ns_;
  try {
    work();
  } catch (const std::exception& error) {
    noteInternalError(error.what());
    if (deblurrer_) {
      deblurrer_->pause();
    }
  }
}

void DeblurNode::noteInternalError(const std::string& error) {
  ++totals_.internal_errors;
  totals_.internal_error = error;
  warnings_.warn("internal error", error, callback_start_ns_);
}

template <typename Work>
void DeblurNode::whileListening(Work&& work) {
  guarded([&] {
    if (inputs_) {
      work();
    }
  });
}

void DeblurNode::receiveEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                               std::int64_t arrived_ns) {
  whileListening([&] {
    // What the array cost and waited before this callback belongs to the latency of the frame that
    // it completes.
    message_arrived_ns_ = arrived_ns;
    totals_.last_events_ns = callback_start_ns_;
    if (comparison_publisher_.getNumSubscribers() > 0) {
      // First: these events may close the frame that they belong to.
      comparison_.addEvents(events, size, parameters_.deblur.event_mapping);
    } else {
      comparison_.clear();
    }
    deblurrer_->addEvents(events, size, sequence, callback_start_ns_);
    inputs_->events->limitWaiting(waitingLimit());
  });
}

/// What buffered events leave of `max_buffered_events` to those that wait.
std::size_t DeblurNode::waitingLimit() const {
  return parameters_.deblur.max_buffered_events - deblurrer_->bufferedEvents();
}

void DeblurNode::receiveLoss(std::size_t events) {
  whileListening([&] { deblurrer_->noteLostEvents(events); });
}

void DeblurNode::receiveImage(const sensor_msgs::ImageConstPtr& message) {
  whileListening([&] {
    totals_.last_frame_ns = callback_start_ns_;
    if (inputs_->image_gaps.step(message->header.seq) == SequenceStep::kGap) {
      totals_.frames_missing += inputs_->image_gaps.missing();
    }
    const ImageReading reading = readImage(*message);
    if (reading.verdict == ImageVerdict::kMalformed) {
      ++totals_.frames_malformed;
      totals_.malformed_reason = reading.reason;
      return;
    }
    if (reading.verdict == ImageVerdict::kUnsupported) {
      totals_.unsupported_reason = reading.reason;
    }
    deblurrer_->addFrame(makeInputFrame(message, reading, callback_start_ns_), callback_start_ns_);
  });
}

void DeblurNode::receiveCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
  whileListening([&] {
    const std::string fault = cameraInfoFault(*message);
    if (!fault.empty()) {
      ++totals_.camera_infos_refused;
      totals_.camera_info_refusal = fault;
      return;
    }
    sink_->setCameraInfo(message);
  });
}

void DeblurNode::receiveExposure(const std_msgs::Int32ConstPtr& message) {
  whileListening([&] { deblurrer_->addExposure(message->data, callback_start_ns_); });
}

void DeblurNode::receiveBiasUpdate(const dynamic_reconfigure::ConfigConstPtr& message) {
  whileListening([&] {
    try {
      LoadedParameters next = withDriverBiases(live_->loaded(), message);
      if (next.deblur.thresholds != parameters_.deblur.thresholds) {
        putInForce(std::move(next));
      }
      driver_biases_ = message;
    } catch (const std::invalid_argument& error) {
      ++totals_.bias_updates_refused;
      totals_.bias_refusal = error.what();
    }
  });
}

/// The same parameters with thresholds from the driver's biases where these have a say.
/// \param biases may be null
/// \throws std::invalid_argument when there is no threshold for them
LoadedParameters DeblurNode::withDriverBiases(
    LoadedParameters parameters, const dynamic_reconfigure::ConfigConstPtr& biases) const {
  if (biases) {
    const auto thresholds = thresholdsAfterBiasUpdate(parameters, *biases);
    if (thresholds) {
      parameters.deblur.thresholds = *thresholds;
      parameters.contrast_origin = "biases on " + topics_.bias_updates;
    }
  }
  return parameters;
}

void DeblurNode::putInForce(LoadedParameters parameters) {
  deblurrer_->setParameters(forPipeline(parameters.deblur));
  const bool contrast_changes = parameters.deblur.thresholds != parameters_.deblur.thresholds ||
                                parameters.contrast_origin != parameters_.contrast_origin;
  parameters_ = std::move(parameters);
  if (contrast_changes) {
    announceContrast();
  }
}

/// Stores \p next once it is in force. Biases of the driver that say nothing about a threshold that
/// is theirs now are dropped.
void DeblurNode::putInForce(LiveParameters next) {
  std::string refusal;
  LoadedParameters parameters;
  try {
    parameters = withDriverBiases(next.loaded(), driver_biases_);
  } catch (const std::invalid_argument& error) {
    refusal = error.what();
    parameters = next.loaded();
  }
  putInForce(std::move(parameters));
  live_ = std::move(next);
  if (!refusal.empty()) {
    ++totals_.bias_updates_refused;
    totals_.bias_refusal = refusal;
    driver_biases_.reset();
  }
}

LiveParameters::Values DeblurNode::reconfigure(const LiveParameters::Values& wanted) {
  LiveParameters::Values in_force;
  guarded([&] {
    LiveParameters next = *live_;
    for (const std::string& refusal : next.change(wanted)) {
      ++totals_.values_refused;
      totals_.value_refusal = refusal;
      ROS_WARN_STREAM(name_ << ": old value kept: " << refusal);
      warnings_.note("values", callback_start_ns_);  // the report need not say it again
    }
    ++totals_.reconfigurations;
    try {
      putInForce(std::move(next));
    } catch (const std::exception& error) {
      ++totals_.values_refused;
      totals_.value_refusal = std::string("all values of one request: ") + error.what();
      ROS_WARN_STREAM(name_ << ": old values kept: " << error.what());
    }
    in_force = live_->values();
    const std::uint32_t latent_queue = latentQueueFor(parameters_.deblur.latent);
    if (latent_queue > latent_queue_) {
      warnings_.warn("latent queue",
                     "the queue of " + latent_publisher_.getTopic() + " holds " +
                         std::to_string(latent_queue_) + " images, expected " +
                         std::to_string(latent_queue) +
                         " for this many latent images: slow subscribers may lose some; set"
                         " latent_images before the node starts",
                     callback_start_ns_);
    }
  });
  subscribersChanged();  // those of latent images count only while there are any
  return in_force;
}

void DeblurNode::advanceClock() {
  whileListening([&] {
    deblurrer_->advance(callback_start_ns_);
    guardAgainstOverload();
  });
}

void DeblurNode::guardAgainstOverload() {
  const DeblurCounters& counts = deblurrer_->counters();
  switch (inputs_->overload.update(
      callback_start_ns_, {counts.events_in, counts.events_overflowed, counts.frames_in})) {
    case OverloadGuard::Advice::kGoOn:
      break;
    case OverloadGuard::Advice::kSuspend:
      if (inputs_->events->suspend(
              [this] { whileListening([&] { deblurrer_->noteMissingArrays(); }); })) {
        ++totals_.event_suspensions;
      }
      break;
    case OverloadGuard::Advice::kResume:
      inputs_->events->resume();
      break;
  }
}

void DeblurNode::deliver(const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                         const OutputFrame& output) {
  deblurred_publisher_.publish(image, info);
  ++totals_.frames_out;
  const std::int64_t published_ns = steadyNow();
  close_latency_.add(published_ns - message_arrived_ns_);
  output_latency_.add(published_ns - messageFrame(output.input).arrival_ns);
  if (output.input.supported && comparison_publisher_.getNumSubscribers() > 0) {
    publishComparison(*image, output);
  }
}

void DeblurNode::publishComparison(const sensor_msgs::Image& image, const OutputFrame& output) {
  const std::int64_t offset_ns = deblurrer_->parameters().time_offset_ns;
  const ExposureInterval window{output.exposure.start_ns + offset_ns,
                                output.exposure.end_ns + offset_ns};
  try {
    comparison_publisher_.publish(
        comparison_.draw(*messageFrame(output.input).message, image, window));
  } catch (const std::exception& error) {
    // A picture for people must not disturb the pipeline that it is drawn in the middle of.
    warnings_.warn("comparison", std::string("no comparison picture: ") + error.what(),
                   callback_start_ns_);
  }
}

NodeSnapshot DeblurNode::snapshot(std::int64_t now_ns) const {
  NodeSnapshot now = totals_;
  now.time_ns = now_ns;
  now.configuration_error = configuration_error_;
  now.listening = inputs_ != nullptr;
  now.contrast_origin = parameters_.contrast_origin;
  if (deblurrer_) {
    now.counters = deblurrer_->counters();
    now.status = deblurrer_->status();
    now.thresholds = deblurrer_->parameters().thresholds;
  }
  return now;
}

void DeblurNode::report() {
  guarded([&] {
    diagnostics_.update(snapshot(callback_start_ns_));
    for (const Complaint& complaint : diagnostics_.complaints()) {
      warnings_.warn(complaint.kind, complaint.text, callback_start_ns_);
    }
    updater_->force_update();
  });
}

}  // namespace fast_edi
