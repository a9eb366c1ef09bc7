/// \file
/// A driver and a consumer in one: publishes to a node under test and collects what it publishes.
/// Every wait has a generous deadline and ends with what is waited for; none is for luck.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <diagnostic_msgs/DiagnosticStatus.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include "rostest/camera_publishers.hpp"
#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {

constexpr std::chrono::seconds kDeadline(30);

/// The value of a diagnostic report, "" when it has none of that name.
std::string valueOf(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key);

class NodeClient {
 public:
  /// \param ns namespace of the node's topics, e.g. "/long_timeout"
  /// \param node name of the node, whose diagnostics are collected
  /// \param output namespace of its output within \p ns
  NodeClient(const std::string& ns, const std::string& node,
             const std::string& output = "deblurred", const InputTopics& inputs = {});

  /// Subscribes to the output; on return all connections in both directions are there.
  /// \return false when the node did not subscribe in time
  bool listen();
  /// Unsubscribes. \return false when the node did not unsubscribe from its inputs in time
  bool stopListening();
  /// True while the node subscribes to all / any of its inputs.
  bool allInputsConnected() const { return camera_.allConnected(); }
  bool anyInputConnected() const { return camera_.anyConnected(); }

  void publish(const Arrival& arrival) { camera_.publish(arrival); }
  void publish(const sensor_msgs::ImageConstPtr& image) { camera_.publish(image); }
  /// Publishes \p recording at real speed.
  void play(const Recording& recording);
  ros::NodeHandle& nodeHandle() { return nh_; }

  /// Waits for \p count outputs. \return those that have come, in order
  std::vector<Output> waitForOutputs(std::size_t count);
  std::size_t outputCount() const;

  using Condition = std::function<bool(const diagnostic_msgs::DiagnosticStatus&)>;
  /// Waits for a report that was received after the call and meets \p condition.
  /// \return false after the deadline
  bool waitForReport(const Condition& condition);
  /// The newest report.
  diagnostic_msgs::DiagnosticStatus report() const;

 private:
  void receiveImage(const sensor_msgs::ImageConstPtr& image);
  void receiveInfo(const sensor_msgs::CameraInfoConstPtr& info);
  void receiveDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& diagnostics);

  std::string ns_;
  std::string node_;
  std::string output_;
  ros::NodeHandle nh_;
  CameraPublishers camera_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<sensor_msgs::ImageConstPtr> images_;
  std::vector<sensor_msgs::CameraInfoConstPtr> infos_;
  diagnostic_msgs::DiagnosticStatus report_;
  std::uint64_t reports_ = 0;

  ros::Subscriber diagnostics_;
  ros::Subscriber output_image_;
  ros::Subscriber output_info_;
  ros::AsyncSpinner spinner_{1};
};

/// Polls \p condition until it holds. \return false after the deadline
bool waitUntil(const std::function<bool()>& condition);

/// True when a publisher of \p topic has a connection to this process, as the publisher sees it.
bool publisherSendsToUs(const std::string& topic);

}  // namespace test
}  // namespace fast_edi
