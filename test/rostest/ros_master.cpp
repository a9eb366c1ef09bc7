#include "rostest/ros_master.hpp"

#include <csignal>
#include <cstdlib>

#include "rostest/free_port.hpp"

namespace fast_edi {
namespace test {

RosMaster::RosMaster() : port_(freePort()), process_({"rosmaster", "--core", "-p", port_}) {
  setenv("ROS_MASTER_URI", ("http://localhost:" + port_).c_str(), 1);
}

RosMaster::~RosMaster() {
  process_.send(SIGTERM);  // Python ignores SIGINT where the shell that started the test does
}

}  // namespace test
}  // namespace fast_edi
