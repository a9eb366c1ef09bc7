#include "rostest/node_client.hpp"

#include <thread>

#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/transport_hints.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcValue.h>

namespace fast_edi {
namespace test {
namespace {

constexpr std::uint32_t kQueue = 1000;
constexpr std::chrono::milliseconds kPoll(10);

/// The XML-RPC address of a node, empty when it is gone.
std::string addressOf(const std::string& node) {
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  request[1] = node;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  if (!ros::master::execute("lookupNode", request, response, payload, false)) {
    return "";
  }
  return payload;
}

std::vector<std::string> publishersOf(const std::string& topic) {
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  std::vector<std::string> publishers;
  if (!ros::master::execute("getSystemState", request, response, payload, false)) {
    return publishers;
  }
  XmlRpc::XmlRpcValue& published = payload[0];
  for (int i = 0; i < published.size(); ++i) {
    if (static_cast<std::string>(published[i][0]) == topic) {
      for (int k = 0; k < published[i][1].size(); ++k) {
        publishers.push_back(published[i][1][k]);
      }
    }
  }
  return publishers;
}

bool sendsToUs(const std::string& node, const std::string& topic) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(addressOf(node), host, port)) {
    return false;
  }
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue request;
  request[0] = ros::this_node::getName();
  XmlRpc::XmlRpcValue response;
  if (!client.execute("getBusInfo", request, response) || client.isFault()) {
    return false;
  }
  // Each connection: id, destination, direction, transport, topic, ...
  XmlRpc::XmlRpcValue& connections = response[2];
  for (int i = 0; i < connections.size(); ++i) {
    XmlRpc::XmlRpcValue& connection = connections[i];
    if (static_cast<std::string>(connection[1]) == ros::this_node::getName() &&
        static_cast<std::string>(connection[2]) == "o" &&
        static_cast<std::string>(connection[4]) == topic) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::string valueOf(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const auto& entry : status.values) {
    if (entry.key == key) {
      return entry.value;
    }
  }
  return "";
}

bool waitUntil(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kDeadline;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    std::this_thread::sleep_for(kPoll);
  }
  return true;
}

bool publisherSendsToUs(const std::string& topic) {
  for (const std::string& node : publishersOf(topic)) {
    if (sendsToUs(node, topic)) {
      return true;
    }
  }
  return false;
}

NodeClient::NodeClient(const std::string& ns, const std::string& node, const std::string& output,
                       const InputTopics& inputs)
    : ns_(ns), node_(node), output_(output), nh_(ns), camera_(nh_, inputs) {
  diagnostics_ = nh_.subscribe("/diagnostics", kQueue, &NodeClient::receiveDiagnostics, this);
  spinner_.start();
}

bool NodeClient::listen() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    images_.clear();
    infos_.clear();
  }
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  output_image_ =
      nh_.subscribe(output_ + "/image_raw", kQueue, &NodeClient::receiveImage, this, no_delay);
  output_info_ =
      nh_.subscribe(output_ + "/camera_info", kQueue, &NodeClient::receiveInfo, this, no_delay);
  return waitUntil([this] {
    return allInputsConnected() && publisherSendsToUs(ns_ + "/" + output_ + "/image_raw") &&
           publisherSendsToUs(ns_ + "/" + output_ + "/camera_info");
  });
}

bool NodeClient::stopListening() {
  output_image_.shutdown();
  output_info_.shutdown();
  return waitUntil([this] { return !anyInputConnected(); });
}

void NodeClient::play(const Recording& recording) {
  const auto start = std::chrono::steady_clock::now();
  for (const Arrival& arrival : recording) {
    std::this_thread::sleep_until(
        start + std::chrono::nanoseconds(arrival.time_ns - recording.front().time_ns));
    publish(arrival);
  }
}

std::vector<Output> NodeClient::waitForOutputs(std::size_t count) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, kDeadline,
                    [&] { return images_.size() >= count && infos_.size() >= count; });
  std::vector<Output> outputs;
  for (std::size_t i = 0; i < images_.size() && i < infos_.size(); ++i) {
    outputs.push_back({images_[i], infos_[i]});
  }
  return outputs;
}

std::size_t NodeClient::outputCount() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return images_.size();
}

bool NodeClient::waitForReport(const Condition& condition) {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t before = reports_;
  return changed_.wait_for(lock, kDeadline,
                           [&] { return reports_ > before && condition(report_); });
}

diagnostic_msgs::DiagnosticStatus NodeClient::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

void NodeClient::receiveImage(const sensor_msgs::ImageConstPtr& image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  images_.push_back(image);
  changed_.notify_all();
}

void NodeClient::receiveInfo(const sensor_msgs::CameraInfoConstPtr& info) {
  const std::lock_guard<std::mutex> lock(mutex_);
  infos_.push_back(info);
  changed_.notify_all();
}

void NodeClient::receiveDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& diagnostics) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const diagnostic_msgs::DiagnosticStatus& status : diagnostics->status) {
    if (status.name == node_.substr(1) + ": deblurring") {
      report_ = status;
      ++reports_;
      changed_.notify_all();
    }
  }
}

}  // namespace test
}  // namespace fast_edi
