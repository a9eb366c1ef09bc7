/// \file
/// Settings of the davis ROS driver that have no say in the contrast thresholds.
#pragma once

#include <string>

namespace fast_edi {

/// Whether the driver's parameter files may have a key of this name beside the biases that the
/// thresholds come from: other biases, exposure, filters, regions of interest and so on. The names
/// are those of davis_ros_driver's dynamic_reconfigure configuration and private parameters.
bool isDriverKey(const std::string& name);

}  // namespace fast_edi
