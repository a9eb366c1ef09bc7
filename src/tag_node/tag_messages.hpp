/// \file
/// Calibration and detections of tags as messages.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>
#include <opencv2/core.hpp>

#include "fast_edi/tags/tag_detector.hpp"
#include "fast_edi/tags/tag_pose.hpp"

namespace fast_edi {

struct CameraReading {
  std::optional<CameraModel> camera;
  std::string reason;  ///< why there is none
};

/// \param info null: none was received
/// \param image_size of the image that the calibration is to hold for
/// \param rectified the image is: P holds, without distortion
CameraReading readCamera(const sensor_msgs::CameraInfo* info, cv::Size image_size, bool rectified);

struct TagMarkerSettings {
  std::string family;       ///< namespace of the markers
  double tag_size_m = 0.0;  ///< side of the tag
};

/// One marker for each tag behind one that deletes those of the frame before: a viewer shows the
/// tags of the newest frame, however many messages it has missed.
///
/// A marker's id is the tag's, its points are the corners [px] by TagCorner with z = 0. With a
/// camera, its pose is the tag's and it is a flat box as large as the tag. Without one, the pose
/// is that of the camera itself and the marker is fully transparent.
visualization_msgs::MarkerArrayPtr makeTagMarkers(const std_msgs::Header& header,
                                                  const std::vector<TagDetection>& tags,
                                                  const std::optional<CameraModel>& camera,
                                                  const TagMarkerSettings& settings);

}  // namespace fast_edi
