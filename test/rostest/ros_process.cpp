#include "rostest/ros_process.hpp"

#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/master.h>

#include "rostest/node_client.hpp"
#include "rostest/ros_master.hpp"

namespace fast_edi {
namespace test {
namespace {

std::unique_ptr<RosMaster> master;

class RosEnvironment : public ::testing::Environment {
 public:
  void TearDown() override {
    if (master) {
      ros::shutdown();
      master.reset();
    }
  }
};

::testing::Environment* const environment = ::testing::AddGlobalTestEnvironment(new RosEnvironment);

}  // namespace

void requireRos() {
  if (master) {
    return;
  }
  master = std::make_unique<RosMaster>();
  ros::init(ros::M_string(), "fast_edi_tests",
            ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
  if (!waitUntil([] { return ros::master::check(); })) {
    throw std::runtime_error("the ROS master did not start");
  }
  ros::start();
}

}  // namespace test
}  // namespace fast_edi
