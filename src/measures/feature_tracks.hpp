/// \file
/// What the front end of visual odometry keeps of an image sequence, after the feature_tracker of
/// VINS-Mono (Qin, Li & Shen, T-RO 2018): corners by Shi and Tomasi (quality 0.01), tracked by
/// pyramidal Lucas-Kanade over 21x21 px forward and back, without outliers of a fundamental matrix,
/// topped up in each frame.
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

struct TrackFigures {
  int tracks = 0;         ///< that have been seen in two frames or more, this one included
  double mean_age = 0.0;  ///< of these, in frames; 0 without any
  /// Share of these that moved with the scene since the frame before: inliers of a homography by
  /// RANSAC. Noise that stands still on the sensor does not. None with fewer than eight tracks.
  std::optional<double> moved_share;
};

struct TrackerSettings {
  int max_features = 150;
  double min_distance_px = 20.0;  ///< between features
};

class FeatureTracker {
 public:
  explicit FeatureTracker(const TrackerSettings& settings) : settings_(settings) {}

  /// \param image CV_8UC1, the next of the sequence
  /// \return nothing for the first image
  /// \throws std::invalid_argument for an image of another type
  std::optional<TrackFigures> track(const cv::Mat& image);

  /// The next image is a first one.
  void clear();

 private:
  /// Keeps the features that both conditions leave. \return places in the image before
  std::vector<cv::Point2f> follow(const cv::Mat& image);
  void topUp(const cv::Mat& image);

  TrackerSettings settings_;
  cv::Mat before_;
  std::vector<cv::Point2f> points_;
  std::vector<int> ages_;  ///< frames in which each has been seen
};

}  // namespace fast_edi
