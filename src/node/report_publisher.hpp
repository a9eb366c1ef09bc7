/// \file
/// How a node reports: `/diagnostics`, and what went wrong in the log.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include "node/node_diagnostics.hpp"
#include "node/throttled_warnings.hpp"

namespace fast_edi {

class ReportPublisher {
 public:
  using Filler = std::function<void(diagnostic_updater::DiagnosticStatusWrapper& status)>;

  /// \param name as shown in the log
  explicit ReportPublisher(const std::string& name) : warnings_(name) {}
  ReportPublisher(const ReportPublisher&) = delete;
  ReportPublisher& operator=(const ReportPublisher&) = delete;

  /// Advertises `/diagnostics`. Once.
  /// \param name as shown in diagnostics
  /// \param task what the node does, which is the name of its status
  /// \param fill called by publish(), and by the updater when it starts
  void advertise(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                 const std::string& name, const std::string& task, const Filler& fill);

  ThrottledWarnings& warnings() { return warnings_; }

  /// Logs the complaints and publishes the status.
  /// \pre advertise() was called
  void publish(const std::vector<Complaint>& complaints, std::int64_t now_ns);

 private:
  ThrottledWarnings warnings_;
  std::optional<diagnostic_updater::Updater> updater_;
};

}  // namespace fast_edi
