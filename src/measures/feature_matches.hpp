/// \file
/// Feature matching between consecutive frames: what visual odometry gains from a sharper picture.
///
/// Detect and describe in both images, match each feature to its two nearest in the other image,
/// keep it when the nearest is closer than 0.8 x the second (Lowe), fit a fundamental matrix by
/// RANSAC at 1 px, count inliers. Detectors run with their library's default settings except where
/// said below.
///
/// Results repeat: OpenCV's RANSAC starts each call from the same seed.
#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

enum class FeatureMethod {
  kSurf,       ///< SURF, by dlib, sampled at each pixel, response of 5 at least
  kFastBrisk,  ///< FAST corners, BRISK descriptors (upright)
  kMserSurf,   ///< MSER regions, SURF descriptors over each region's extent
  kMserOrb,    ///< MSER regions, concentric ones taken once, ORB descriptors (upright, 31 px)
  kBrisk,      ///< BRISK
  kOrb,        ///< ORB, 2000 features at most instead of 500, which would hide gains
};

/// All methods, in the order of reports.
constexpr std::array<FeatureMethod, 6> kAllFeatureMethods = {
    FeatureMethod::kSurf,    FeatureMethod::kFastBrisk, FeatureMethod::kMserSurf,
    FeatureMethod::kMserOrb, FeatureMethod::kBrisk,     FeatureMethod::kOrb};
/// Short name, e.g. "FAST+BRISK".
const char* toString(FeatureMethod method);
/// SURF descriptors need dlib.
bool needsDlib(FeatureMethod method);

/// Features of one image, kept so that each image is looked at once.
struct ImageFeatures {
  std::vector<cv::Point2f> points;  ///< [px]
  cv::Mat descriptors;              ///< one row for each point: CV_8U (Hamming) or CV_32F (L2)
};

/// \throws std::invalid_argument unless \p image is CV_8UC1 and not empty
/// \throws UnavailableError for SURF descriptors without dlib
ImageFeatures findFeatures(const cv::Mat& image, FeatureMethod method);

struct MatchCounts {
  int features_first = 0;
  int features_second = 0;
  int matches = 0;  ///< passed the ratio test
  int inliers = 0;  ///< of the fundamental matrix; 0 with fewer than kMinMatchesForModel matches
};

/// Below this OpenCV does not run RANSAC.
constexpr int kMinMatchesForModel = 15;

MatchCounts matchFeatures(const ImageFeatures& first, const ImageFeatures& second);

}  // namespace fast_edi
