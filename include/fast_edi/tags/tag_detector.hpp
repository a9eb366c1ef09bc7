/// \file
/// AprilTags in a frame, by libapriltag.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

/// Families that can be detected, by libapriltag's names without their "tag". 36h10 needs
/// libapriltag 3.2.
constexpr std::array<const char*, 9> kTagFamilies = {
    "36h11",       "36h10",       "25h9",          "16h5",          "Circle21h7",
    "Circle49h12", "Custom48h12", "Standard41h12", "Standard52h13",
};

/// Corners of the tag's outline (of the black square, in most families) by their place on the
/// upright tag. The order is that of libapriltag and apriltag_ros.
enum TagCorner { kBottomLeft, kBottomRight, kTopRight, kTopLeft };

struct TagDetection {
  int id = 0;
  int hamming = 0;                     ///< bits corrected
  double decision_margin = 0.0;        ///< mean distance of a bit from its threshold [DN]
  cv::Point2d centre;                  ///< [px]
  std::array<cv::Point2d, 4> corners;  ///< by TagCorner [px]
};

/// Defaults are those of libapriltag and apriltag_ros, except that frames are not decimated: DAVIS
/// frames are small.
struct TagDetectorSettings {
  std::string family = "36h11";
  int corrected_bits = 2;  ///< 0..2; fewer give fewer false tags and smaller tables
  double decimate = 1.0;   ///< tags are searched in a frame smaller by this factor, >= 1
  int threads = 1;         ///< >= 1
};

/// libapriltag's detector, owned. Equal frames give equal detections. Not to be called from two
/// threads at once.
class TagDetector {
 public:
  /// Tables of the largest families do not fit with two corrected bits.
  static constexpr double kMaxTableBytes = 512e6;

  /// \throws std::invalid_argument for settings out of range, and for a family newer than
  /// libapriltag, naming what was expected
  /// \throws std::runtime_error when libapriltag cannot allocate the detector
  explicit TagDetector(const TagDetectorSettings& settings = {});
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;

  /// Detections in increasing order of id. An id that is seen twice counts twice. Coordinates are
  /// those of OpenCV and ROS: the centre of the top left pixel is (0, 0).
  /// \param image CV_8UC1, any step
  /// \throws std::invalid_argument for another type or an empty image
  std::vector<TagDetection> detect(const cv::Mat& image) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
