// Detects AprilTags in a process of its own.

#include <cstdlib>

#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include "tag_node/tag_detector_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "tag_detector");
  const ros::NodeHandle nh;
  const fast_edi::TagDetectorNode node(nh, ros::NodeHandle("~"), ros::this_node::getName());
  if (!node.configurationError().empty()) {
    return EXIT_FAILURE;  // the message is in the log already
  }
  ros::spin();
  return EXIT_SUCCESS;
}
