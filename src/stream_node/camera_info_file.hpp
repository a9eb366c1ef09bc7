/// \file
#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>

namespace fast_edi {

/// A calibration as `camera_calibration` and `camera_info_manager` write it: YAML with image_width,
/// image_height, distortion_model, and camera_matrix, distortion_coefficients,
/// rectification_matrix, projection_matrix, each with its numbers in `data`.
/// \throws std::runtime_error that names the file and what is wrong in it
sensor_msgs::CameraInfo readCameraInfoFile(const std::string& path);

}  // namespace fast_edi
