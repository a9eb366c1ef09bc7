/// \file
/// The service `save_learned` of a node: writes what was learned from the recording to a file,
/// where the next run can start.
#pragma once

#include <functional>
#include <string>

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi {

/// Where that file lies.
/// \param given the parameter `learned_file`; a relative path starts at ROS's folder, `$ROS_HOME`
/// or
///        `~/.ros`. Empty: the name of the node there, e.g. `dvs_deblur_learned.yaml`
/// \param node_name with slashes, e.g. `/dvs/deblur`
std::string learnedFilePath(const std::string& given, const std::string& node_name);

/// Threads. Requests are answered in the thread of the node handle's queue. Let that be a
/// CallbackThread, so that events need not wait for the disk, and stop it before destroying this
/// object.
class LearnedService {
 public:
  /// Returns the state of the pipeline; what it locks is free again before anything is written.
  using Reader = std::function<DeblurStatus()>;

  /// \param private_nh of the node, with the queue for requests
  /// \param path of the file, see learnedFilePath(); an existing one is replaced
  LearnedService(ros::NodeHandle private_nh, std::string path, Reader read);
  LearnedService(const LearnedService&) = delete;
  LearnedService& operator=(const LearnedService&) = delete;

 private:
  bool save(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response) const;

  const std::string path_;
  const Reader read_;
  ros::ServiceServer server_;
};

}  // namespace fast_edi
