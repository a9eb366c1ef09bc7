/// \file
/// What `/diagnostics` and the log say about the streams of DV.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "node/node_diagnostics.hpp"
#include "stream/stream_client.hpp"

namespace fast_edi {

/// One stream at the time of a report.
struct StreamReport {
  StreamKind kind = StreamKind::kEvents;
  std::string server;  ///< address and port, or path
  StreamStatus status;
};

/// Everything that a report is made from. Counts are totals since construction.
struct StreamSnapshot {
  std::int64_t time_ns = 0;         ///< steady clock
  std::string configuration_error;  ///< not empty: the node is idle for good
  std::vector<StreamReport> streams;
  std::uint64_t frames_without_exposure = 0;
  std::uint64_t frames_without_calibration = 0;
};

/// Turns snapshots into reports. Rates and complaints refer to the time since the snapshot before.
class StreamDiagnostics {
 public:
  /// Compares with the snapshot before, which \p now replaces: one of the same streams.
  void update(const StreamSnapshot& now);

  /// Of the last update().
  const std::vector<Complaint>& complaints() const { return complaints_; }
  /// What is new and no complaint, of the last update(): connections that were made.
  const std::vector<std::string>& news() const { return news_; }

  /// The report of the last update().
  void fill(diagnostic_updater::DiagnosticStatusWrapper& wrapper) const;

 private:
  void compare(const StreamReport& now, const StreamStatus& before);
  void compareFrames();
  void summarise(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  StreamSnapshot before_;
  StreamSnapshot now_;
  std::vector<Complaint> complaints_;
  std::vector<std::string> news_;
};

}  // namespace fast_edi
