/// \file
/// A camera without distortion.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// The optical axis meets the middle of the image.
struct PinholeCamera {
  SensorSize size;
  double focal_length_px;

  /// Ray through a pixel in the optical frame, of length 1 along the axis.
  Eigen::Vector3d rayOf(const cv::Point2d& pixel) const {
    return {(pixel.x - 0.5 * (size.width - 1)) / focal_length_px,
            (pixel.y - 0.5 * (size.height - 1)) / focal_length_px, 1.0};
  }

  /// Pixel that sees a point of the optical frame. \pre the point lies before the camera
  cv::Point2d project(const Eigen::Vector3d& point) const {
    return {focal_length_px * point.x() / point.z() + 0.5 * (size.width - 1),
            focal_length_px * point.y() / point.z() + 0.5 * (size.height - 1)};
  }
};

}  // namespace fast_edi
