/// \file
/// What a deblurring node reports about itself: totals, latencies, warnings, `/diagnostics`.
#pragma once

#include <cstdint>
#include <string>

#include <ros/node_handle.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "node/latency_record.hpp"
#include "node/node_diagnostics.hpp"
#include "node/report_publisher.hpp"

namespace fast_edi {

class NodeReport {
 public:
  /// \param name as shown in log and diagnostics
  NodeReport(const std::string& name, const InputTopics& topics);
  NodeReport(const NodeReport&) = delete;
  NodeReport& operator=(const NodeReport&) = delete;

  /// Advertises `/diagnostics`. Once.
  void advertise(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                 const std::string& name);

  /// What the node counts itself.
  NodeSnapshot& totals() { return snapshot_; }
  const NodeSnapshot& totals() const { return snapshot_; }

  /// Inputs are received from now on.
  void startListening(std::int64_t now_ns);
  /// A frame was published.
  /// \param completed_ns arrival of the message that completed it
  /// \param arrived_ns arrival of the frame
  void addOutput(std::int64_t published_ns, std::int64_t completed_ns, std::int64_t arrived_ns);
  void addInternalError(const std::string& error, std::int64_t now_ns);
  /// Some of the values that a request set live.
  void addRefusedValue(const std::string& refusal);
  /// \param refusal nothing is refused if empty
  void addRefusedBiases(const std::string& refusal);
  void addRefusedCameraInfo(const std::string& refusal);

  /// Throttled: see ThrottledWarnings.
  ThrottledWarnings& warnings() { return publisher_.warnings(); }

  /// State of the pipeline for the next report.
  /// \param listening whether inputs are wanted
  void setPipeline(const Deblurrer& deblurrer, const std::string& contrast_origin, bool listening);
  /// Publishes the report, and logs what went wrong since the last one.
  void publish(std::int64_t now_ns);

 private:
  NodeSnapshot snapshot_;
  LatencyRecord close_latency_;
  LatencyRecord output_latency_;
  NodeDiagnostics diagnostics_;
  ReportPublisher publisher_;
};

}  // namespace fast_edi
