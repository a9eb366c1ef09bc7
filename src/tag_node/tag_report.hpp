/// \file
/// What a tag detector reports about itself: totals, detection times, warnings, `/diagnostics`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <ros/node_handle.h>

#include "fast_edi/events/sequence_gaps.hpp"
#include "node/latency_record.hpp"
#include "node/repeated_messages.hpp"
#include "node/report_publisher.hpp"
#include "tag_node/tag_diagnostics.hpp"

namespace fast_edi {

class TagReport {
 public:
  /// \param name as shown in log and diagnostics
  /// \param image_topic as resolved, for messages
  TagReport(const std::string& name, const std::string& image_topic);
  TagReport(const TagReport&) = delete;
  TagReport& operator=(const TagReport&) = delete;

  /// Advertises `/diagnostics`. Once.
  void advertise(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh,
                 const std::string& name);

  /// What the node counts itself.
  TagSnapshot& totals() { return snapshot_; }
  const TagSnapshot& totals() const { return snapshot_; }

  /// Images are received from now on.
  void startListening(std::int64_t now_ns);
  /// An image has come.
  /// \param sequence its header.seq
  void addArrival(std::uint32_t sequence, std::int64_t now_ns);
  /// Whether it is the one before once more, which is counted; see repeated_messages.hpp.
  bool repeats(const boost::shared_ptr<const void>& image);
  /// It cannot be searched.
  void addRefusedImage(const std::string& refusal);
  /// It was searched.
  void addFrame(std::size_t tags);
  /// Its tags were published.
  void addDetectionTime(std::int64_t duration_ns) { detection_time_.add(duration_ns); }
  void addInternalError(const std::string& error, std::int64_t now_ns);

  /// Publishes the report, and logs what went wrong since the last one.
  /// \param listening the images are subscribed to
  /// \pre advertise() was called
  void publish(bool listening, std::int64_t now_ns);

 private:
  TagSnapshot snapshot_;
  SequenceGaps image_gaps_;
  RepeatedPointers repeated_images_;
  LatencyRecord detection_time_;
  TagDiagnostics diagnostics_;
  ReportPublisher publisher_;
};

}  // namespace fast_edi
