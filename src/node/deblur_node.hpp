/// \file
/// The ROS side of the pipeline, the same for node and nodelet: topics, parameters, clock and
/// diagnostics around a Deblurrer. Topic names are relative; src/node/README.md lists them.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "fast_edi/messages/message_frame_sink.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "node/callback_thread.hpp"
#include "node/learned_service.hpp"
#include "node/node_inputs.hpp"
#include "node/node_outputs.hpp"
#include "node/node_report.hpp"
#include "node/parameters_in_force.hpp"
#include "node/periodic_callback.hpp"
#include "node/reconfigure_server.hpp"

namespace fast_edi {

/// Threads. Callbacks come from the node handles' callback queue. Events, frames and exposures have
/// to be handled in the order of their arrival, so that queue must call one callback at a time: a
/// nodelet's getNodeHandle() whatever the number of the manager's worker threads, or ros::spin(). A
/// queue that calls several at once does no harm beyond that order. Changes of parameters,
/// subscribers that come and go, saving what was learned, and subscribing to the inputs are handled
/// by a CallbackThread.
///
/// mutex_ guards all members that callbacks use: everything after it. Each callback holds it from
/// beginning to end. It is needed even with a queue as above, which is still running while the
/// destructor is at work.
///
/// Nobody calls the ROS master with mutex_ held, nor in the thread of the inputs: that takes time
/// and, while there is no master, may not end. The CallbackThread subscribes to the inputs, once
/// the master can be reached; until then the node continues with the subscriptions that it has.
///
/// Event arrays alone are received in roscpp's thread, which never waits for mutex_: see
/// waiting_arrays.hpp.
///
/// Order of locks: that of ReconfigureServer, mutex_, then any lock inside ROS (publishing,
/// diagnostics) or of EventSubscription, WaitingArrays and CallbackThread. The CallbackThread is
/// stopped without mutex_. What waits for callbacks to end (ending subscriptions and
/// PeriodicCallbacks) is done without mutex_, since such a callback may be waiting for it.
///
/// Starting. What can fail comes before what calls back; when it fails, the destructor runs.
///
/// Closing. First the CallbackThread ends, then the inputs and the clock, then the report, then the
/// publishers, which are never replaced before: no callback can meet a publisher that is gone.
///
/// No exception leaves a callback: one that gets here is logged and reported, and the pipeline
/// restarts.
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
  const std::string& configurationError() const { return report_.totals().configuration_error; }

 private:
  struct NotStarted {};
  /// The callback at work [ns, steady clock].
  struct Callback {
    std::int64_t start_ns = 0;
    std::int64_t arrived_ns = 0;  ///< its message; at most start_ns
  };

  DeblurNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh, const std::string& name,
             NotStarted);
  void start();
  void configure();
  void subscribersChanged();
  std::unique_ptr<NodeInputs> makeInputs();
  /// Subscribes to what is missing, if the master can be reached.
  void updateInputs();

  void receiveEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                     std::int64_t arrived_ns);
  void receiveImage(const sensor_msgs::ImageConstPtr& message);
  void receiveCameraInfo(const sensor_msgs::CameraInfoConstPtr& message);
  void advanceClock();
  LiveParameters::Values reconfigure(const LiveParameters::Values& wanted);
  void report();
  DeblurStatus status();

  std::size_t maxWaitingEvents() const;
  void deliver(const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
               const OutputFrame& output);
  void publishComparison(const sensor_msgs::Image& image, const OutputFrame& output);

  /// Runs a callback's work under the mutex.
  template <typename Work>
  void withLock(Work&& work);
  /// The same for what comes from the inputs; nothing once they have ended.
  template <typename Work>
  void withInputs(Work&& work);

  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
  std::string name_;

  CallbackThread callback_thread_;  ///< outlives the publishers and the server that use its queue

  std::mutex mutex_;
  NodeReport report_;
  std::optional<ParametersInForce> parameters_;  ///< none when idle for good
  std::optional<MessageFrameSink> sink_;
  std::unique_ptr<Deblurrer> deblurrer_;  ///< null when idle for good
  NodeOutputs outputs_;
  Callback callback_;
  std::optional<PeriodicCallback> reporting_;
  /// Null while nobody listens; exchanged by the CallbackThread alone.
  std::unique_ptr<NodeInputs> inputs_;
  std::unique_ptr<ReconfigureServer> reconfigure_server_;  ///< none when idle for good
  std::optional<LearnedService> learned_service_;          ///< none when idle for good
};

}  // namespace fast_edi
