/// \file
/// The dynamic_reconfigure server of a driver: knows some settings and remembers what was set.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

namespace fast_edi {
namespace test {

class FakeDriver {
 public:
  /// \param node name that the server stands for
  /// \param settings names and types ("int" or "bool") of what can be set
  FakeDriver(const std::string& node, const std::map<std::string, std::string>& settings);

  /// Everything that was set so far; booleans as 0 and 1.
  std::map<std::string, int> set() const;
  /// Announces settings as in force, as the driver does after each change.
  void announce(const std::map<std::string, int>& integers);

 private:
  bool receive(dynamic_reconfigure::Reconfigure::Request& request,
               dynamic_reconfigure::Reconfigure::Response& response);

  ros::NodeHandle nh_;
  ros::Publisher descriptions_;
  ros::Publisher updates_;
  ros::ServiceServer server_;
  mutable std::mutex mutex_;
  std::map<std::string, int> set_;
};

}  // namespace test
}  // namespace fast_edi
