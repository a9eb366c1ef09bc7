/// \file
/// A ROS master of a test's own.
#pragma once

#include <string>

#include "rostest/child_process.hpp"

namespace fast_edi {
namespace test {

/// Runs from construction to destruction; ROS_MASTER_URI leads this process to it. Must be there
/// before the first node handle.
class RosMaster {
 public:
  RosMaster();
  ~RosMaster();
  RosMaster(const RosMaster&) = delete;
  RosMaster& operator=(const RosMaster&) = delete;

 private:
  std::string port_;
  ChildProcess process_;
};

}  // namespace test
}  // namespace fast_edi
