/// \file
/// What `/diagnostics` and the log say about the pipeline: values, level, and why.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "node/latency_record.hpp"

namespace fast_edi {

/// Names of the inputs as resolved, for messages.
struct InputTopics {
  std::string events;
  std::string image;
  std::string exposure;
  std::string bias_updates;
};

/// Everything that a report is made from. Counts are totals since construction.
struct NodeSnapshot {
  std::int64_t time_ns = 0;         ///< steady clock
  std::string configuration_error;  ///< not empty: the node is idle for good
  bool listening = false;           ///< inputs are wanted
  bool master_missing = false;      ///< so that they cannot be changed
  std::int64_t listening_since_ns = 0;
  std::int64_t last_frame_ns = 0;   ///< arrival on the steady clock; 0 = none since listening
  std::int64_t last_events_ns = 0;  ///< same
  DeblurCounters counters;
  DeblurStatus status;
  std::uint64_t frames_out = 0;
  std::uint64_t frames_malformed = 0;
  std::uint64_t frames_missing = 0;     ///< numbers left out in header.seq of the images
  std::uint64_t messages_repeated = 0;  ///< arrays, frames, exposures that came twice: dropped
  std::uint64_t event_suspensions = 0;  ///< times that events were not received, see OverloadGuard
  std::uint64_t camera_infos_refused = 0;
  std::uint64_t bias_updates_refused = 0;
  std::uint64_t reconfigurations = 0;  ///< requests to change parameters
  std::uint64_t values_refused = 0;    ///< in those requests
  std::uint64_t internal_errors = 0;
  std::string malformed_reason;     ///< of the last one
  std::string unsupported_reason;   ///< of the last one
  std::string camera_info_refusal;  ///< of the last one
  std::string bias_refusal;         ///< of the last one
  std::string value_refusal;        ///< of the last one
  std::string internal_error;       ///< of the last one
  ContrastThresholds thresholds;
  std::string contrast_origin;
};

/// One thing that went wrong since the last report.
struct Complaint {
  std::string kind;  ///< the same for all complaints of one kind
  std::string text;  ///< where, how many, what was expected
};

/// Turns snapshots into reports. Rates and complaints refer to the time since the snapshot before.
class NodeDiagnostics {
 public:
  explicit NodeDiagnostics(InputTopics topics);

  /// Compares with the snapshot before, which \p now replaces.
  void update(const NodeSnapshot& now);

  /// Of the last update(): what was dropped, refused or passed through.
  const std::vector<Complaint>& complaints() const { return complaints_; }

  /// The report of the last update().
  void fill(const LatencyRecord& close_latency, const LatencyRecord& output_latency,
            diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  void collectComplaints(const NodeSnapshot& now);
  void summarise(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  InputTopics topics_;
  NodeSnapshot before_;
  NodeSnapshot now_;
  std::vector<Complaint> complaints_;
};

}  // namespace fast_edi
