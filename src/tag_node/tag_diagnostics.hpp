/// \file
/// What `/diagnostics` and the log say about the tag detector.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "node/latency_record.hpp"
#include "node/node_diagnostics.hpp"

namespace fast_edi {

/// Everything that a report is made from. Counts are totals since construction.
struct TagSnapshot {
  std::int64_t time_ns = 0;         ///< steady clock
  std::string configuration_error;  ///< not empty: the node is idle for good
  bool listening = false;           ///< the images are subscribed to
  std::int64_t listening_since_ns = 0;
  std::int64_t last_frame_ns = 0;  ///< arrival on the steady clock; 0 = none since listening
  std::uint64_t frames = 0;        ///< searched for tags
  std::uint64_t frames_with_tags = 0;
  std::uint64_t tags = 0;
  std::uint64_t tags_in_last_frame = 0;
  std::uint64_t frames_refused = 0;
  std::uint64_t frame_gaps = 0;       ///< holes in header.seq
  std::uint64_t frames_repeated = 0;  ///< came twice: dropped
  std::uint64_t internal_errors = 0;
  std::string refusal;         ///< of the last one
  std::string internal_error;  ///< of the last one
  std::string no_pose_reason;  ///< empty: tags of the last frame have poses
  std::string frame_id;        ///< of the last frame
};

/// Turns snapshots into reports. Rates and complaints refer to the time since the snapshot before.
class TagDiagnostics {
 public:
  /// \param image_topic as resolved, for messages
  explicit TagDiagnostics(std::string image_topic);

  /// Compares with the snapshot before, which \p now replaces.
  void update(const TagSnapshot& now);

  /// Of the last update().
  const std::vector<Complaint>& complaints() const { return complaints_; }

  /// The report of the last update().
  void fill(const LatencyRecord& detection_time,
            diagnostic_updater::DiagnosticStatusWrapper& wrapper) const;

 private:
  void summarise(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  std::string image_topic_;
  TagSnapshot before_;
  TagSnapshot now_;
  std::vector<Complaint> complaints_;
};

}  // namespace fast_edi
