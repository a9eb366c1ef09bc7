/// \file
/// DV's streams as the topics of the DAVIS driver, the same for node and nodelet: parameters,
/// clients, outputs and diagnostics. Topic names are relative; launch/dv_stream.md lists them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "fast_edi/config/dv_stream_parameters.hpp"
#include "node/periodic_callback.hpp"
#include "node/report_publisher.hpp"
#include "stream/stream_client.hpp"
#include "stream_node/event_output.hpp"
#include "stream_node/frame_output.hpp"
#include "stream_node/sample_outputs.hpp"
#include "stream_node/stream_diagnostics.hpp"

namespace fast_edi {

/// Each stream is received and published in a thread of its own; the report comes from \p nh's
/// callback queue. No exception leaves a thread: one that gets there ends the connection, which is
/// reported and made anew.
class DvStreamNode {
 public:
  /// A configuration that cannot be used is logged and reported on /diagnostics; the object then
  /// stays idle, see configurationError().
  /// \param name as shown in log and diagnostics, with a leading slash
  DvStreamNode(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
               const std::string& name);
  /// Waits for messages that are just being published, and for a resolver that was asked for the
  /// address of a name.
  ~DvStreamNode();
  DvStreamNode(const DvStreamNode&) = delete;
  DvStreamNode& operator=(const DvStreamNode&) = delete;

  /// Empty unless the configuration was refused.
  const std::string& configurationError() const { return configuration_error_; }

 private:
  void configure();
  void connect(const DvStreamParameters& parameters, StreamKind kind, const DvStreamPlace& place,
               StreamSink& sink);
  void report();

  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
  const std::string name_;
  std::string configuration_error_;
  StreamDiagnostics diagnostics_;
  ReportPublisher publisher_;
  std::unique_ptr<EventOutput> events_;  ///< null: not received
  std::unique_ptr<FrameOutput> frames_;
  std::unique_ptr<ImuOutput> imu_;
  std::unique_ptr<TriggerOutput> triggers_;
  std::vector<std::unique_ptr<StreamClient>> clients_;  ///< ended before the outputs
  std::optional<PeriodicCallback> reporting_;  ///< ended before the clients that it looks at
};

}  // namespace fast_edi
