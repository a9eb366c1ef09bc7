/// \file
/// Simulated recordings in the shape that each driver gives its own: topics, types, stamps and what
/// is missing.
#pragma once

#include <string>
#include <vector>

#include <sensor_msgs/Image.h>

#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {

struct DriverShape {
  std::string node;        ///< name of the driver's node
  InputTopics topics;      ///< absolute names
  std::string simulation;  ///< options of simulate_davis that depend on the driver
  bool is_dv_ros = false;  ///< dv_ros_msgs; array stamps of the last event; calibration at 25 Hz
};

/// davis_ros_driver of rpg_dvs_ros: frames stamped in the middle of their exposure, exposure times
/// after them, unstamped camera_info beside each event array.
DriverShape davisRosDriver();

/// capture_node of dv-ros: frames stamped at the start of their exposure, no exposure times.
DriverShape dvRos();

struct SimulatedRecording {
  Recording recording;
  std::vector<sensor_msgs::ImageConstPtr> truth;  ///< sharp frames, stamped mid-exposure
};

/// \param tools folder of simulate_davis
/// \param options for it
/// \throws std::runtime_error with what the tool printed when it failed
SimulatedRecording simulateRecording(const std::string& tools, const DriverShape& shape,
                                     const std::string& options);

/// Writes \p recording as the driver's topics and types.
void writeBag(const Recording& recording, const DriverShape& shape, const std::string& path);

/// Peak signal-to-noise ratio over all samples of two 8-bit images of equal size and encoding [dB].
double psnrOf(const sensor_msgs::Image& image, const sensor_msgs::Image& truth);

/// Outputs that deblur_bag added to a bag.
std::vector<Output> readOutputs(const std::string& path, const std::string& output_namespace);

}  // namespace test
}  // namespace fast_edi
