/// \file
/// The ROS side of the pipeline, the same for node and nodelet: topics, parameters, clock and
/// diagnostics around a Deblurrer. Topic names are relative; src/node/README.md lists them.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <dynamic_reconfigure/Config.h>
#include <image_transport/image_transport.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "fast_edi/config/live_parameters.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/events/sequence_gaps.hpp"
#include "fast_edi/messages/message_frame_sink.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "node/comparison_view.hpp"
#include "node/event_subscription.hpp"
#include "node/latency_record.hpp"
#include "node/node_diagnostics.hpp"
#include "node/overload_guard.hpp"
#include "node/reconfigure_server.hpp"
#include "node/side_thread.hpp"
#include "node/throttled_warnings.hpp"

namespace fast_edi {

/// Threads. Callbacks come from the node handles' callback queue. Events, frames and exposures have
/// to be handled in the order of their arrival, so that queue must call one callback at a time: a
/// nodelet's getNodeHandle() whatever the number of the manager's worker threads, or ros::spin(). A
/// queue that calls several at once does no harm beyond that order. Changes of parameters,
/// subscribers that come and go, and subscribing to the inputs are handled by a SideThread.
///
/// mutex_ guards all members that callbacks use: everything from sink_ on, live_, parameters_
/// and driver_biases_. Each callback holds it from beginning to end. It is needed even
/// with a queue as above, which is still running while the destructor is at work.
///
/// Nobody calls the ROS master with mutex_ held, nor in the thread of the inputs: that takes time
/// and, while there is no master, may not end. Inputs are subscribed to by the SideThread, once the
/// master can be reached; until then the node works on with what it has.
///
/// Event arrays alone are taken in by roscpp's thread, which never waits for mutex_: see
/// waiting_arrays.hpp.
///
/// Order of locks: that of ReconfigureServer, mutex_, then any lock inside ROS (publishing,
/// diagnostics) or of EventSubscription, WaitingArrays and SideThread. The SideThread is stopped
/// without mutex_. The other way round would be to hold mutex_ while waiting for a callback to end,
/// which may be waiting for mutex_. So what waits for callbacks (ending subscriptions, timers and
/// publishers) is done without holding it.
///
/// Starting. What can fail comes before what calls back; when it fails, the destructor runs.
///
/// Closing. First the SideThread ends, then the inputs and the clock, then the report, then the
/// publishers, which are never replaced before: at no time can a callback meet a publisher that is
/// gone.
///
/// No exception leaves a callback: one that gets here is logged, reported and the pipeline starts
/// anew.
class DeblurNode {
 public:
  /// A configuration that cannot be used is logged and reported on /diagnostics; the object then
  /// stays idle, see configurationError().
  /// \param name as shown in log and diagnostics, with a leading slash
  DeblurNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, const std::string& name);
  ~DeblurNode();
  DeblurNode(const DeblurNode&) = delete;
  DeblurNode& operator=(const DeblurNode&) = delete;

  /// Empty unless the configuration was refused.
  const std::string& configurationError() const { return configuration_error_; }

 private:
  /// What is received while somebody wants outputs: input subscriptions and the clock, which come
  /// and go together.
  struct Inputs {
    SequenceGaps image_gaps;
    OverloadGuard overload;
    std::unique_ptr<EventSubscription> events;
    // Of the SideThread alone:
    ros::SteadyTimer advance_timer;
    image_transport::Subscriber image;
    ros::Subscriber camera_info;
    ros::Subscriber exposure;
    ros::Subscriber bias_updates;
    bool subscribed = false;  ///< to all of them; the events may be suspended
  };
  struct NotStarted {};

  DeblurNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, const std::string& name,
             NotStarted);
  void start();
  void configure();
  void advertise();
  bool isWanted() const;
  void subscribersChanged();
  std::unique_ptr<Inputs> makeInputs();
  /// Subscribes to what is missing, if the master can be reached.
  void updateInputs();
  void subscribe(Inputs& inputs);

  void receiveEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                     std::int64_t arrived_ns);
  void receiveLoss(std::size_t events);
  std::size_t waitingLimit() const;
  void receiveImage(const sensor_msgs::ImageConstPtr& message);
  void receiveCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);
  void receiveExposure(const std_msgs::Int32ConstPtr& message);
  void receiveBiasUpdate(const dynamic_reconfigure::ConfigConstPtr& message);
  LiveParameters::Values reconfigure(const LiveParameters::Values& wanted);
  void advanceClock();
  /// Stops and resumes receiving events, see OverloadGuard.
  void guardAgainstOverload();
  void report();

  LoadedParameters withDriverBiases(LoadedParameters parameters,
                                    const dynamic_reconfigure::ConfigConstPtr& biases) const;
  void putInForce(LoadedParameters parameters);
  void putInForce(LiveParameters next);
  void announceContrast() const;
  void deliver(const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
               const OutputFrame& output);
  void publishComparison(const sensor_msgs::Image& image, const OutputFrame& output);
  NodeSnapshot snapshot(std::int64_t now_ns) const;
  void noteInternalError(const std::string& error);

  /// Runs a callback's work under the mutex.
  template <typename Work>
  void guarded(Work&& work);
  /// The same for what comes from the inputs; nothing once they have ended.
  template <typename Work>
  void whileListening(Work&& work);

  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
  std::string name_;
  std::string configuration_error_;
  InputTopics topics_;
  std::optional<LiveParameters> live_;  ///< as set; none when idle for good
  LoadedParameters parameters_;         ///< in force: the same with the driver's biases
  dynamic_reconfigure::ConfigConstPtr driver_biases_;  ///< the last that could be used

  SideThread side_thread_;  ///< outlives the publishers and the server that use its queue

  std::mutex mutex_;
  std::optional<MessageFrameSink> sink_;
  std::unique_ptr<Deblurrer> deblurrer_;  ///< null when idle for good
  ComparisonView comparison_;
  LatencyRecord close_latency_;
  LatencyRecord output_latency_;
  NodeDiagnostics diagnostics_;
  NodeSnapshot totals_;  ///< the part of the snapshot that is counted here
  std::int64_t callback_start_ns_ = 0;
  std::int64_t message_arrived_ns_ = 0;  ///< the message at hand; at most callback_start_ns_
  ThrottledWarnings warnings_;

  image_transport::CameraPublisher deblurred_publisher_;
  image_transport::Publisher comparison_publisher_;
  image_transport::Publisher latent_publisher_;
  std::uint32_t latent_queue_ = 0;  ///< of that publisher [images]
  std::optional<diagnostic_updater::Updater> updater_;
  ros::SteadyTimer report_timer_;
  ros::SteadyTimer retry_timer_;
  /// Null while nobody listens; exchanged by the SideThread alone.
  std::unique_ptr<Inputs> inputs_;
  std::unique_ptr<ReconfigureServer> reconfigure_server_;  ///< none when idle for good
};

}  // namespace fast_edi
