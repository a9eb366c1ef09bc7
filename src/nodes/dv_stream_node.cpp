// Receives the streams of DV in a process of its own.

#include <cstdlib>

#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include "stream_node/dv_stream_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "dv_stream_node");
  const ros::NodeHandle nh;
  const fast_edi::DvStreamNode node(nh, ros::NodeHandle("~"), ros::this_node::getName());
  if (!node.configurationError().empty()) {
    return EXIT_FAILURE;  // the message is in the log already
  }
  ros::spin();
  return EXIT_SUCCESS;
}
