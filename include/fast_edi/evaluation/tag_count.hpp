/// \file
/// AprilTags (family 36h11) in a frame: what a robot gains from a sharper picture.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

struct TagDetection {
  int id = 0;
  int hamming = 0;                     ///< bits corrected
  double decision_margin = 0.0;        ///< mean distance of a bit from its threshold [DN]
  cv::Point2d center;                  ///< [px]
  std::array<cv::Point2d, 4> corners;  ///< [px], in libapriltag's order around the tag
};

/// libapriltag's detector for 36h11, owned. Runs in one thread, so results repeat.
///
/// Settings: libapriltag's and apriltag_ros's defaults (2 bits corrected, sharpening 0.25, refined
/// edges), but no decimation: DAVIS frames are small.
class TagDetector {
 public:
  /// \throws std::runtime_error when libapriltag cannot allocate the detector
  TagDetector();
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// Detections in increasing order of id. An id that is seen twice counts twice.
  /// \param image CV_8UC1, any step
  /// \throws std::invalid_argument for another type or an empty image
  std::vector<TagDetection> detect(const cv::Mat& image) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
