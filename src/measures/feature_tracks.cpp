#include "measures/feature_tracks.hpp"

#include <algorithm>
#include <numeric>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "measures/image_metrics.hpp"

namespace fast_edi {
namespace {

constexpr double kQuality = 0.01;
constexpr int kFlowWindowPx = 21;
constexpr int kPyramidLevels = 3;
constexpr double kReturnPx = 0.5;    ///< between a feature and where tracking back ends
constexpr double kEpipolarPx = 1.0;  ///< from the epipolar line
constexpr double kTrackConfidence = 0.99;
constexpr std::size_t kMinForModel = 8;  ///< of a fundamental matrix
constexpr double kHomographyPx = 2.0;
constexpr int kBorderPx = 1;

bool isInside(const cv::Point2f& point, const cv::Size& size) {
  return point.x >= kBorderPx && point.y >= kBorderPx && point.x < size.width - kBorderPx &&
         point.y < size.height - kBorderPx;
}

template <typename Value>
void keep(std::vector<Value>& values, const std::vector<bool>& kept) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (kept[i]) values[count++] = values[i];
  }
  values.resize(count);
}

std::vector<bool> onEpipolarLines(const std::vector<cv::Point2f>& from,
                                  const std::vector<cv::Point2f>& to) {
  std::vector<bool> kept(from.size(), true);
  if (from.size() < kMinForModel) return kept;
  cv::Mat inliers;
  const cv::Mat model =
      cv::findFundamentalMat(from, to, cv::FM_RANSAC, kEpipolarPx, kTrackConfidence, inliers);
  // Without a model OpenCV leaves the mask uninitialised.
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = !model.empty() && inliers.at<std::uint8_t>(static_cast<int>(i)) != 0;
  }
  return kept;
}

std::optional<double> shareOfHomography(const std::vector<cv::Point2f>& from,
                                        const std::vector<cv::Point2f>& to) {
  if (from.size() < kMinForModel) return std::nullopt;
  cv::Mat inliers;
  const cv::Mat model = cv::findHomography(from, to, cv::RANSAC, kHomographyPx, inliers);
  if (model.empty()) return 0.0;
  return static_cast<double>(cv::countNonZero(inliers)) / static_cast<double>(from.size());
}

}  // namespace

void FeatureTracker::clear() {
  before_.release();
  points_.clear();
  ages_.clear();
}

std::vector<cv::Point2f> FeatureTracker::follow(const cv::Mat& image) {
  std::vector<cv::Point2f> from = points_;
  if (from.empty()) return from;
  std::vector<cv::Point2f> to;
  std::vector<cv::Point2f> back;
  std::vector<std::uint8_t> found;
  std::vector<std::uint8_t> found_back;
  std::vector<float> error;
  const cv::Size window(kFlowWindowPx, kFlowWindowPx);
  cv::calcOpticalFlowPyrLK(before_, image, from, to, found, error, window, kPyramidLevels);
  cv::calcOpticalFlowPyrLK(image, before_, to, back, found_back, error, window, kPyramidLevels);
  std::vector<bool> kept(from.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    kept[i] = found[i] != 0 && found_back[i] != 0 && cv::norm(back[i] - from[i]) <= kReturnPx &&
              isInside(to[i], image.size());
  }
  keep(from, kept);
  keep(to, kept);
  keep(ages_, kept);
  const std::vector<bool> on_lines = onEpipolarLines(from, to);
  keep(from, on_lines);
  keep(to, on_lines);
  keep(ages_, on_lines);
  points_ = to;
  return from;
}

void FeatureTracker::topUp(const cv::Mat& image) {
  // The oldest features first: of two that have come together the older one stays.
  std::vector<std::size_t> order(points_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [this](std::size_t a, std::size_t b) { return ages_[a] > ages_[b]; });
  cv::Mat1b free(image.size(), std::uint8_t{255});
  std::vector<cv::Point2f> points;
  std::vector<int> ages;
  for (const std::size_t i : order) {
    const cv::Point place(points_[i]);
    if (free(place) == 0) continue;
    points.push_back(points_[i]);
    ages.push_back(ages_[i]);
    cv::circle(free, place, static_cast<int>(settings_.min_distance_px), cv::Scalar(0), cv::FILLED);
  }
  const int wanted = settings_.max_features - static_cast<int>(points.size());
  if (wanted > 0) {
    std::vector<cv::Point2f> more;
    cv::goodFeaturesToTrack(image, more, wanted, kQuality, settings_.min_distance_px, free);
    points.insert(points.end(), more.begin(), more.end());
    ages.resize(points.size(), 1);
  }
  points_ = points;
  ages_ = ages;
}

std::optional<TrackFigures> FeatureTracker::track(const cv::Mat& image) {
  requireMono8(image, "image to track in");
  std::optional<TrackFigures> figures;
  if (!before_.empty()) {
    const std::vector<cv::Point2f> from = follow(image);
    for (int& age : ages_) ++age;
    figures.emplace();
    figures->tracks = static_cast<int>(points_.size());
    if (!ages_.empty()) {
      figures->mean_age =
          std::accumulate(ages_.begin(), ages_.end(), 0.0) / static_cast<double>(ages_.size());
    }
    figures->moved_share = shareOfHomography(from, points_);
  }
  topUp(image);
  before_ = image.clone();
  return figures;
}

}  // namespace fast_edi
